/* SPDX-License-Identifier: MIT
 * Any bytes -> lexer -> parser. Besides not crashing: tokens lie in order inside the text, memory
 * comes back, and an assigned expression can be printed.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "lang/evaluate/evaluator.h"
#include "lang/parse/parser.h"
#include "text/lexer.h"

enum { STACK_BYTES = 4 << 20 }; /* of this thread's own, for the parser */

static void check_tokens(csg_program *program, uint32_t source)
{
    csg_token_array tokens = {0};
    const csg_source *text = &program->sources.items[source];
    uint32_t end = 0;
    if (csg_lex(&program->sources, source, &tokens))
        for (size_t i = 0; i < tokens.count; i++) {
            const csg_token *token = &tokens.items[i];
            if (token->offset < end || token->offset + token->length > text->length ||
                (token->kind == CSG_TOKEN_END) != (i + 1 == tokens.count))
                fuzz_fail("tokens overlap or leave the text", text->text, text->length);
            end = token->offset + token->length;
        }
    csg_tokens_release(&program->context->memory, &tokens);
}

static void print_variables(csg_program *program)
{
    csg_text text = {.memory = &program->context->memory};
    const csg_scope *scope = program->files[0]->scope;
    for (uint32_t i = 0; i < scope->variable_count && !text.failed; i++)
        csg_text_put_expression(&text, scope->variables[i].value, &program->symbols);
    csg_text_reset(&text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csg_program program;
    csgm_scene_options options = {0};
    uint32_t source;
    char here;
    fuzz_context_init(&context);
    fuzz_text scene = fuzz_files_open(data, size);
    csg_program_init(&program, &context);
    if (csg_source_add(&program.sources, "scene.txt", scene.text, scene.length, &source) ==
        CSGM_OK) {
        program.stack_end = (uintptr_t)&here - STACK_BYTES;
        check_tokens(&program, source);
        csgm_status status = csg_parse_program(&program, source, &options);
        if (status != CSGM_OK && context.diags.errors == 0)
            fuzz_fail("refused without a word", scene.text, scene.length);
        if (status == CSGM_OK)
            print_variables(&program);
    }
    csg_program_reset(&program);
    fuzz_files_close();
    fuzz_context_close(&context);
    return 0;
}
