/* SPDX-License-Identifier: MIT
 * Prints the lexer's tokens of each file: "file NAME", then "KIND offset length" a line. KIND is
 * the name in tokens.def, or KEYWORD or PUNCTUATION.
 */
#include <stdio.h>
#include <stdlib.h>

#include "text/lexer.h"

static const char *kind_of(const csg_token *token)
{
    switch ((csg_token_kind)token->kind) {
#define CSG_TOKEN(NAME, text)                                                                      \
    case CSG_TOKEN_##NAME:                                                                         \
        return #NAME;
#define CSG_KEYWORD(NAME, text)                                                                    \
    case CSG_TOKEN_##NAME:                                                                         \
        return "KEYWORD";
#define CSG_PUNCTUATION(NAME, text)                                                                \
    case CSG_TOKEN_##NAME:                                                                         \
        return "PUNCTUATION";
#include "text/tokens.def"
    default:
        return "?";
    }
}

static int print_tokens(csgm_context *context, const char *path)
{
    csg_arena arena;
    csg_sources sources;
    csg_token_array tokens = {0};
    uint32_t source;
    csg_source_request request = {.path = path, .from = {UINT32_MAX, 0, 0}, .textual = true};
    csg_arena_init(&arena, &context->memory);
    csg_sources_init(&sources, context, &arena);
    bool good = csg_source_read(&sources, &request, &source) == CSGM_OK &&
                csg_lex(&sources, source, &tokens);
    printf("file %s\n", path);
    for (size_t i = 0; good && i < tokens.count; i++)
        printf("%s %u %u\n", kind_of(&tokens.items[i]), tokens.items[i].offset,
               tokens.items[i].length);
    csg_tokens_release(&context->memory, &tokens);
    csg_sources_reset(&sources);
    csg_arena_reset(&arena);
    return good ? 0 : 1;
}

int main(int argument_count, char **arguments)
{
    csgm_context context = {0};
    int failed = 0;
    csg_memory_init(&context.memory, NULL, 0);
    for (int i = 1; i < argument_count; i++)
        failed |= print_tokens(&context, arguments[i]);
    return failed;
}
