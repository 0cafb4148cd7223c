/* SPDX-License-Identifier: MIT
 * Expressions: precedence climbing over the binary operators, recursive descent for the rest.
 * Precedence, loosest first: ?:  ||  &&  == !=  < <= > >=  |  &  << >>  + -  * / %  unary + - ! ~  ^
 * call index .
 * As in OpenSCAD 2021, ^ binds tighter than a sign before it (-2^2 = -4) and groups to the right.
 */
#include "base/scene_codes.h"
#include "lang/parse/ast_kinds.h"
#include "lang/parse/parser_private.h"

static csg_expression *parse_unary(csg_parser *parser);
static csg_expression *parse_element(csg_parser *parser);

static csg_expression *make_expression(csg_parser *parser, csg_expression_kind kind, csg_span where)
{
    csg_expression *made = csg_parser_alloc(parser, sizeof *made);
    if (made) {
        made->kind = (uint8_t)kind;
        made->where = where;
        made->whole = where;
    }
    return made;
}

static csg_expression *end_expression(csg_parser *parser, csg_expression *made, csg_span from)
{
    made->whole = csg_parser_since(parser, from);
    return made;
}

/* ---- argument lists ---------------------------------------------------------------------- */

static bool add_argument(csg_parser *parser, csg_arguments *out, csg_argument argument)
{
    csg_argument *place =
        csg_arena_push(&parser->program->arena, (void **)&out->items, &out->count, sizeof argument);
    if (!place) {
        csg_parser_no_memory(parser);
        return false;
    }
    *place = argument;
    return true;
}

static bool at_assignment(const csg_parser *parser)
{
    return csg_parser_peek(parser) == CSG_TOKEN_NAME &&
           parser->tokens.items[parser->at + 1].kind == CSG_TOKEN_ASSIGN;
}

static bool parse_argument(csg_parser *parser, csg_arguments *out)
{
    csg_argument argument = {.where = csg_parser_span(parser)};
    if (at_assignment(parser)) {
        argument.name = csg_parser_symbol(parser, argument.where);
        parser->program->symbols.entries[argument.name].variable = true;
        csg_parser_next(parser);
        csg_parser_next(parser);
    }
    argument.value = csg_parse_expression(parser);
    if (argument.value && !argument.name)
        argument.where = argument.value->whole;
    return argument.value && add_argument(parser, out, argument);
}

bool csg_parse_arguments(csg_parser *parser, csg_arguments *out)
{
    csg_span open = csg_parser_span(parser);
    if (!csg_parser_expect(parser, CSG_TOKEN_OPEN_ROUND, "before the arguments"))
        return false;
    while (csg_parser_peek(parser) != CSG_TOKEN_CLOSE_ROUND) {
        if (csg_parser_accept(parser, CSG_TOKEN_COMMA))
            continue; /* OpenSCAD lets commas stand in a row */
        if (!parse_argument(parser, out))
            return false;
        if (csg_parser_peek(parser) != CSG_TOKEN_COMMA)
            break;
    }
    return csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open);
}

void csg_parser_drop_doubles(csg_parser *parser, csg_arguments *assignments)
{
    enum { MOST = 1000 }; /* the check is quadratic */
    uint32_t kept = 0;
    for (uint32_t i = 0; i < assignments->count && assignments->count <= MOST; i++) {
        const csg_argument *made = &assignments->items[i];
        uint32_t before = 0;
        while (before < kept && (!made->name || assignments->items[before].name != made->name))
            before++;
        if (before == kept)
            assignments->items[kept++] = *made;
        else
            csg_source_report(&parser->program->sources, CSG_DIAG_DUPLICATE_ARGUMENT, made->where,
                              NULL, "'%s' is assigned twice here, the first one holds",
                              csg_symbol_name(&parser->program->symbols, made->name));
    }
    if (assignments->count <= MOST)
        assignments->count = kept;
}

static bool parse_parameter(csg_parser *parser, csg_arguments *out)
{
    csg_argument parameter = {.where = csg_parser_span(parser)};
    if (csg_parser_peek(parser) != CSG_TOKEN_NAME) {
        csg_parser_unexpected(parser, CSG_DIAG_EXPECTED, "the name of a parameter", NULL);
        return false;
    }
    parameter.name = csg_parser_symbol(parser, parameter.where);
    parser->program->symbols.entries[parameter.name].variable = true;
    csg_parser_next(parser);
    if (csg_parser_accept(parser, CSG_TOKEN_ASSIGN)) {
        parameter.value = csg_parse_expression(parser);
        if (!parameter.value)
            return false;
    }
    for (uint32_t i = 0; i < out->count; i++)
        if (out->items[i].name == parameter.name) {
            csg_source_report(&parser->program->sources, CSG_DIAG_DUPLICATE_PARAMETER,
                              parameter.where, NULL, "the parameter '%s' is declared twice",
                              csg_symbol_name(&parser->program->symbols, parameter.name));
            return true;
        }
    return add_argument(parser, out, parameter);
}

bool csg_parse_parameters(csg_parser *parser, csg_arguments *out)
{
    enum { MOST = 1000 }; /* the check for doubles is quadratic */
    csg_span open = csg_parser_span(parser);
    if (!csg_parser_expect(parser, CSG_TOKEN_OPEN_ROUND, "before the parameters"))
        return false;
    while (csg_parser_peek(parser) != CSG_TOKEN_CLOSE_ROUND) {
        if (csg_parser_accept(parser, CSG_TOKEN_COMMA))
            continue;
        if (out->count == MOST) {
            csg_source_report(&parser->program->sources, CSG_DIAG_EXPECTED, csg_parser_span(parser),
                              NULL, "more than %d parameters", (int)MOST);
            return false;
        }
        if (!parse_parameter(parser, out))
            return false;
        if (csg_parser_peek(parser) != CSG_TOKEN_COMMA)
            break;
    }
    return csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open);
}

/* ---- let, assert, echo, function literals ------------------------------------------------- */

static bool begins_expression(csg_token_kind kind)
{
    switch (kind) {
    case CSG_TOKEN_NAME:
    case CSG_TOKEN_NUMBER:
    case CSG_TOKEN_STRING:
    case CSG_TOKEN_TRUE:
    case CSG_TOKEN_FALSE:
    case CSG_TOKEN_UNDEF:
    case CSG_TOKEN_FUNCTION:
    case CSG_TOKEN_LET:
    case CSG_TOKEN_ASSERT:
    case CSG_TOKEN_ECHO:
    case CSG_TOKEN_OPEN_ROUND:
    case CSG_TOKEN_OPEN_SQUARE:
    case CSG_TOKEN_PLUS:
    case CSG_TOKEN_MINUS:
    case CSG_TOKEN_NOT:
    case CSG_TOKEN_BIT_NOT:
    case CSG_TOKEN_FOR:
    case CSG_TOKEN_IF:
    case CSG_TOKEN_EACH:
        return true;
    default:
        return false;
    }
}

/* `element`: the body may be a for, if or each of a list comprehension. */
static csg_expression *parse_prefixed(csg_parser *parser, csg_expression_kind kind, bool element)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, kind, from);
    csg_parser_next(parser);
    if (!made || !csg_parse_arguments(parser, &made->as.call.arguments))
        return NULL;
    if (kind == CSG_EXPRESSION_LET)
        csg_parser_drop_doubles(parser, &made->as.call.arguments);
    bool optional = kind == CSG_EXPRESSION_ASSERT || kind == CSG_EXPRESSION_ECHO;
    if (optional && !begins_expression(csg_parser_peek(parser)))
        return end_expression(parser, made, from);
    made->as.call.body = element ? parse_element(parser) : csg_parse_expression(parser);
    return made->as.call.body ? end_expression(parser, made, from) : NULL;
}

static csg_expression *parse_function(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_FUNCTION, from);
    csg_parser_next(parser);
    if (!made || !csg_parse_parameters(parser, &made->as.call.arguments))
        return NULL;
    made->as.call.body = csg_parse_expression(parser);
    return made->as.call.body ? end_expression(parser, made, from) : NULL;
}

/* ---- elements of a vector ------------------------------------------------------------------ */

static bool parse_assignments(csg_parser *parser, csg_token_kind end, csg_arguments *out)
{
    while (csg_parser_peek(parser) != end && csg_parser_peek(parser) != CSG_TOKEN_SEMICOLON) {
        if (csg_parser_accept(parser, CSG_TOKEN_COMMA))
            continue;
        if (!parse_argument(parser, out))
            return false;
        if (csg_parser_peek(parser) != CSG_TOKEN_COMMA)
            break;
    }
    return true;
}

/* After "for (first;": the rest of a loop. */
static csg_expression *parse_loop(csg_parser *parser, csg_expression *made, csg_span open)
{
    csg_arguments first = made->as.call.arguments;
    made->kind = CSG_EXPRESSION_FOR_LOOP;
    made->as.loop.next = (csg_arguments){0};
    made->as.loop.first = first;
    made->as.loop.condition = csg_parse_expression(parser);
    if (!made->as.loop.condition ||
        !csg_parser_expect(parser, CSG_TOKEN_SEMICOLON, "after the loop's condition") ||
        !parse_assignments(parser, CSG_TOKEN_CLOSE_ROUND, &made->as.loop.next) ||
        !csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open))
        return NULL;
    csg_parser_drop_doubles(parser, &made->as.loop.first);
    csg_parser_drop_doubles(parser, &made->as.loop.next);
    made->as.loop.body = parse_element(parser);
    return made->as.loop.body ? made : NULL;
}

static csg_expression *parse_for(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_FOR, from);
    csg_parser_next(parser);
    csg_span open = csg_parser_span(parser);
    if (!made || !csg_parser_expect(parser, CSG_TOKEN_OPEN_ROUND, "after 'for'") ||
        !parse_assignments(parser, CSG_TOKEN_CLOSE_ROUND, &made->as.call.arguments))
        return NULL;
    if (csg_parser_accept(parser, CSG_TOKEN_SEMICOLON)) {
        made = parse_loop(parser, made, open);
        return made ? end_expression(parser, made, from) : NULL;
    }
    if (!csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open))
        return NULL;
    made->as.call.body = parse_element(parser);
    return made->as.call.body ? end_expression(parser, made, from) : NULL;
}

static csg_expression *parse_if(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_IF, from);
    csg_parser_next(parser);
    csg_span open = csg_parser_span(parser);
    if (!made || !csg_parser_expect(parser, CSG_TOKEN_OPEN_ROUND, "after 'if'"))
        return NULL;
    made->as.branch.condition = csg_parse_expression(parser);
    if (!made->as.branch.condition || !csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open))
        return NULL;
    made->as.branch.then = parse_element(parser);
    if (!made->as.branch.then)
        return NULL;
    if (csg_parser_accept(parser, CSG_TOKEN_ELSE)) {
        made->as.branch.other = parse_element(parser);
        if (!made->as.branch.other)
            return NULL;
    }
    return end_expression(parser, made, from);
}

static csg_expression *parse_each(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_EACH, from);
    csg_parser_next(parser);
    if (!made)
        return NULL;
    made->as.inner = parse_element(parser);
    return made->as.inner ? end_expression(parser, made, from) : NULL;
}

/* Does a generator follow this opening parenthesis? ( for ..., ( each ..., ( let(...) for ... */
static bool opens_generator(const csg_parser *parser)
{
    size_t i = parser->at;
    while (parser->tokens.items[i].kind == CSG_TOKEN_OPEN_ROUND)
        i++;
    csg_token_kind kind = parser->tokens.items[i].kind;
    return kind == CSG_TOKEN_FOR || kind == CSG_TOKEN_IF || kind == CSG_TOKEN_EACH;
}

static csg_expression *parse_generator(csg_parser *parser)
{
    switch (csg_parser_peek(parser)) {
    case CSG_TOKEN_FOR:
        return parse_for(parser);
    case CSG_TOKEN_IF:
        return parse_if(parser);
    case CSG_TOKEN_EACH:
        return parse_each(parser);
    case CSG_TOKEN_LET:
        return parse_prefixed(parser, CSG_EXPRESSION_LET, true);
    case CSG_TOKEN_ASSERT:
        return parse_prefixed(parser, CSG_EXPRESSION_ASSERT, true);
    case CSG_TOKEN_ECHO:
        return parse_prefixed(parser, CSG_EXPRESSION_ECHO, true);
    default:
        break;
    }
    csg_span open = csg_parser_span(parser);
    csg_parser_next(parser);
    csg_expression *inner = parse_element(parser);
    return inner && csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open) ? inner : NULL;
}

static csg_expression *parse_element(csg_parser *parser)
{
    csg_token_kind kind = csg_parser_peek(parser);
    bool generator = kind == CSG_TOKEN_FOR || kind == CSG_TOKEN_IF || kind == CSG_TOKEN_EACH ||
                     kind == CSG_TOKEN_LET || kind == CSG_TOKEN_ASSERT || kind == CSG_TOKEN_ECHO ||
                     (kind == CSG_TOKEN_OPEN_ROUND && opens_generator(parser));
    if (!generator)
        return csg_parse_expression(parser);
    if (!csg_parser_enter(parser))
        return NULL;
    csg_expression *made = parse_generator(parser);
    csg_parser_leave(parser);
    return made;
}

static csg_expression *parse_range(csg_parser *parser, csg_expression *first, csg_span open)
{
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_RANGE, open);
    csg_parser_next(parser);
    if (!made)
        return NULL;
    made->as.range.begin = first;
    made->as.range.end = csg_parse_expression(parser);
    if (!made->as.range.end)
        return NULL;
    if (csg_parser_accept(parser, CSG_TOKEN_COLON)) {
        made->as.range.step = made->as.range.end;
        made->as.range.end = csg_parse_expression(parser);
        if (!made->as.range.end)
            return NULL;
    }
    return csg_parser_close(parser, CSG_TOKEN_CLOSE_SQUARE, open)
               ? end_expression(parser, made, open)
               : NULL;
}

/* Is it one element of a list, whatever its value is? */
static bool is_one_element(const csg_expression *x)
{
    return x->kind != CSG_EXPRESSION_FOR && x->kind != CSG_EXPRESSION_FOR_LOOP &&
           x->kind != CSG_EXPRESSION_IF && x->kind != CSG_EXPRESSION_EACH &&
           x->kind != CSG_EXPRESSION_LET && x->kind != CSG_EXPRESSION_ASSERT &&
           x->kind != CSG_EXPRESSION_ECHO;
}

static csg_expression *parse_bracketed(csg_parser *parser)
{
    csg_span open = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_VECTOR, open);
    csg_parser_next(parser);
    if (made)
        made->as.list.is_plain = true;
    while (made && csg_parser_peek(parser) != CSG_TOKEN_CLOSE_SQUARE) {
        if (csg_parser_accept(parser, CSG_TOKEN_COMMA))
            continue;
        csg_expression *element = parse_element(parser);
        if (!element)
            return NULL;
        if (csg_parser_peek(parser) == CSG_TOKEN_COLON && made->as.list.count == 0)
            return parse_range(parser, element, open);
        csg_expression **place =
            csg_arena_push(&parser->program->arena, (void **)&made->as.list.items,
                           &made->as.list.count, sizeof element);
        if (!place) {
            csg_parser_no_memory(parser);
            return NULL;
        }
        *place = element;
        made->as.list.is_plain = made->as.list.is_plain && is_one_element(element);
        if (csg_parser_peek(parser) != CSG_TOKEN_COMMA)
            break;
    }
    return made && csg_parser_close(parser, CSG_TOKEN_CLOSE_SQUARE, open)
               ? end_expression(parser, made, open)
               : NULL;
}

/* ---- primary and postfix -------------------------------------------------------------------- */

static csg_expression *parse_literal(csg_parser *parser)
{
    csg_span where = csg_parser_span(parser);
    const char *text = parser->text + where.offset;
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_UNDEF, where);
    if (!made)
        return NULL;
    switch (csg_parser_peek(parser)) {
    case CSG_TOKEN_NUMBER:
        made->kind = CSG_EXPRESSION_NUMBER;
        made->as.number = csg_token_number(text, where.length);
        break;
    case CSG_TOKEN_STRING:
        made->kind = CSG_EXPRESSION_STRING;
        made->as.string.text =
            csg_token_string(&parser->program->arena, text, where.length, &made->as.string.length);
        if (!made->as.string.text)
            csg_parser_no_memory(parser);
        break;
    case CSG_TOKEN_NAME:
        made->kind = CSG_EXPRESSION_NAME;
        made->as.name = csg_parser_symbol(parser, where);
        made->slot = parser->program->slot_count++;
        break;
    case CSG_TOKEN_TRUE:
    case CSG_TOKEN_FALSE:
        made->kind = CSG_EXPRESSION_BOOLEAN;
        made->as.boolean = csg_parser_peek(parser) == CSG_TOKEN_TRUE;
        break;
    default:
        break;
    }
    csg_parser_next(parser);
    return made;
}

static const char *hint_for_keyword(csg_token_kind kind)
{
    switch (kind) {
    case CSG_TOKEN_FOR:
    case CSG_TOKEN_EACH:
        return "a list comprehension stands in brackets: [for (i = [0 : 3]) i]";
    case CSG_TOKEN_IF:
        return "a choice in an expression is: condition ? this : that";
    case CSG_TOKEN_ASSIGN:
        return "'==' compares, '=' assigns";
    default:
        return NULL;
    }
}

static csg_expression *parse_primary(csg_parser *parser)
{
    csg_token_kind kind = csg_parser_peek(parser);
    switch (kind) {
    case CSG_TOKEN_NUMBER:
    case CSG_TOKEN_STRING:
    case CSG_TOKEN_NAME:
    case CSG_TOKEN_TRUE:
    case CSG_TOKEN_FALSE:
    case CSG_TOKEN_UNDEF:
        return parse_literal(parser);
    case CSG_TOKEN_OPEN_SQUARE:
        return parse_bracketed(parser);
    case CSG_TOKEN_OPEN_ROUND: {
        csg_span open = csg_parser_span(parser);
        csg_parser_next(parser);
        csg_expression *inner = csg_parse_expression(parser);
        if (!inner || !csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open))
            return NULL;
        return end_expression(parser, inner, open);
    }
    default:
        csg_parser_unexpected(parser, CSG_DIAG_EXPECTED_EXPRESSION, "an expression",
                              hint_for_keyword(kind));
        return NULL;
    }
}

static csg_expression *parse_index(csg_parser *parser, csg_expression *object)
{
    csg_span open = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_INDEX, open);
    csg_parser_next(parser);
    if (!made)
        return NULL;
    made->as.pair.left = object;
    made->as.pair.right = csg_parse_expression(parser);
    return made->as.pair.right && csg_parser_close(parser, CSG_TOKEN_CLOSE_SQUARE, open) ? made
                                                                                         : NULL;
}

static csg_expression *parse_member(csg_parser *parser, csg_expression *object)
{
    csg_parser_next(parser);
    csg_span where = csg_parser_span(parser);
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_MEMBER, where);
    if (!made || !csg_parser_expect(parser, CSG_TOKEN_NAME, "after '.'"))
        return NULL;
    made->as.member.object = object;
    made->as.member.name = csg_parser_symbol(parser, where);
    return made;
}

static csg_expression *parse_call(csg_parser *parser, csg_expression *callee)
{
    csg_expression *made = make_expression(parser, CSG_EXPRESSION_CALL, callee->where);
    if (!made)
        return NULL;
    made->as.call.callee = callee;
    return csg_parse_arguments(parser, &made->as.call.arguments) ? made : NULL;
}

static csg_expression *parse_postfix(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *made = parse_primary(parser);
    while (made && !parser->stop) {
        csg_token_kind kind = csg_parser_peek(parser);
        if (kind == CSG_TOKEN_OPEN_ROUND)
            made = parse_call(parser, made);
        else if (kind == CSG_TOKEN_OPEN_SQUARE)
            made = parse_index(parser, made);
        else if (kind == CSG_TOKEN_DOT)
            made = parse_member(parser, made);
        else
            break;
        if (made)
            end_expression(parser, made, from);
    }
    return parser->stop ? NULL : made;
}

/* ---- operators ---------------------------------------------------------------------------------
 */

static csg_expression *make_pair(csg_parser *parser, csg_expression_kind kind, csg_span sign,
                                 csg_expression *left, csg_expression *right)
{
    csg_expression *made = left && (right || kind == CSG_EXPRESSION_UNARY)
                               ? make_expression(parser, kind, sign)
                               : NULL;
    if (made) {
        made->as.pair.left = left;
        made->as.pair.right = right;
    }
    return made;
}

/* A sign and what it stands before, or what stands right of '^': one level deeper. */
static csg_expression *parse_operand(csg_parser *parser)
{
    if (!csg_parser_enter(parser))
        return NULL;
    csg_expression *made = parse_unary(parser);
    csg_parser_leave(parser);
    return made;
}

static csg_expression *parse_power(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *left = parse_postfix(parser);
    if (!left || csg_parser_peek(parser) != CSG_TOKEN_CARET)
        return left;
    csg_span sign = csg_parser_span(parser);
    csg_parser_next(parser);
    csg_expression *made =
        make_pair(parser, CSG_EXPRESSION_BINARY, sign, left, parse_operand(parser));
    if (!made)
        return NULL;
    made->operation = CSG_TOKEN_CARET;
    return end_expression(parser, made, from);
}

static csg_expression *parse_unary(csg_parser *parser)
{
    csg_token_kind kind = csg_parser_peek(parser);
    if (kind != CSG_TOKEN_MINUS && kind != CSG_TOKEN_PLUS && kind != CSG_TOKEN_NOT &&
        kind != CSG_TOKEN_BIT_NOT)
        return parse_power(parser);
    csg_span sign = csg_parser_span(parser);
    csg_parser_next(parser);
    csg_expression *made =
        make_pair(parser, CSG_EXPRESSION_UNARY, sign, parse_operand(parser), NULL);
    if (!made)
        return NULL;
    made->operation = (uint8_t)kind;
    return end_expression(parser, made, sign);
}

static int precedence(csg_token_kind kind)
{
    switch (kind) {
    case CSG_TOKEN_OR:
        return 1;
    case CSG_TOKEN_AND:
        return 2;
    case CSG_TOKEN_EQUAL:
    case CSG_TOKEN_NOT_EQUAL:
        return 3;
    case CSG_TOKEN_LESS:
    case CSG_TOKEN_LESS_EQUAL:
    case CSG_TOKEN_GREATER:
    case CSG_TOKEN_GREATER_EQUAL:
        return 4;
    case CSG_TOKEN_BIT_OR:
        return 5;
    case CSG_TOKEN_BIT_AND:
        return 6;
    case CSG_TOKEN_SHIFT_LEFT:
    case CSG_TOKEN_SHIFT_RIGHT:
        return 7;
    case CSG_TOKEN_PLUS:
    case CSG_TOKEN_MINUS:
        return 8;
    case CSG_TOKEN_STAR:
    case CSG_TOKEN_SLASH:
    case CSG_TOKEN_PERCENT:
        return 9;
    default:
        return 0;
    }
}

/* All operators that bind at least as tightly as `least`; recursion at most 9 levels deep. */
static csg_expression *parse_binary(csg_parser *parser, int least)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *left = parse_unary(parser);
    while (left) {
        csg_token_kind kind = csg_parser_peek(parser);
        int level = precedence(kind);
        if (level == 0 || level < least)
            return left;
        csg_span sign = csg_parser_span(parser);
        csg_parser_next(parser);
        left =
            make_pair(parser, CSG_EXPRESSION_BINARY, sign, left, parse_binary(parser, level + 1));
        if (left) {
            left->operation = (uint8_t)kind;
            end_expression(parser, left, from);
        }
    }
    return NULL;
}

static csg_expression *parse_conditional(csg_parser *parser)
{
    csg_span from = csg_parser_span(parser);
    csg_expression *condition = parse_binary(parser, 1);
    if (!condition || csg_parser_peek(parser) != CSG_TOKEN_QUESTION)
        return condition;
    csg_expression *made =
        make_expression(parser, CSG_EXPRESSION_CONDITIONAL, csg_parser_span(parser));
    csg_parser_next(parser);
    if (!made)
        return NULL;
    made->as.branch.condition = condition;
    made->as.branch.then = csg_parse_expression(parser);
    if (!made->as.branch.then ||
        !csg_parser_expect(parser, CSG_TOKEN_COLON, "between the two choices of '?'"))
        return NULL;
    made->as.branch.other = csg_parse_expression(parser);
    return made->as.branch.other ? end_expression(parser, made, from) : NULL;
}

csg_expression *csg_parse_expression(csg_parser *parser)
{
    if (!csg_parser_enter(parser))
        return NULL;
    csg_expression *made = NULL;
    switch (csg_parser_peek(parser)) {
    case CSG_TOKEN_LET:
        made = parse_prefixed(parser, CSG_EXPRESSION_LET, false);
        break;
    case CSG_TOKEN_ASSERT:
        made = parse_prefixed(parser, CSG_EXPRESSION_ASSERT, false);
        break;
    case CSG_TOKEN_ECHO:
        made = parse_prefixed(parser, CSG_EXPRESSION_ECHO, false);
        break;
    case CSG_TOKEN_FUNCTION:
        made = parse_function(parser);
        break;
    default:
        made = parse_conditional(parser);
        break;
    }
    csg_parser_leave(parser);
    return made;
}
