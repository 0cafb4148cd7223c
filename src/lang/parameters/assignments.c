/* SPDX-License-Identifier: MIT
 * Assignments of the scene's own file, found and replaced; see assignments.h.
 */
#include "lang/parameters/assignments.h"

#include <stdio.h>
#include <string.h>

csg_assignment *csg_assignment_find(csg_program *program, csg_symbol name)
{
    csg_scope *scope = program->files[0]->scope;
    uint32_t known = csg_members_find(&program->members, scope->id, CSG_MEMBER_VARIABLE, name);
    return known == UINT32_MAX ? NULL : &scope->variables[known];
}

bool csg_assignment_replace(csg_program *program, csg_symbol name, csg_expression *value)
{
    csg_assignment *known = csg_assignment_find(program, name);
    if (known)
        *known = (csg_assignment){name, value, value->whole};
    return known != NULL;
}

const char *csg_assignment_suggest(const csg_program *program, const char *name, char *buffer,
                                   size_t size)
{
    const csg_scope *scope = program->files[0]->scope;
    size_t length = strlen(name);
    const char *best = NULL;
    uint32_t least = length <= 2 ? 1 : length <= 5 ? 2 : 3;
    for (uint32_t i = 0; i < scope->variable_count && least > 0; i++) {
        const char *other = csg_symbol_name(&program->symbols, scope->variables[i].name);
        uint32_t distance = csg_edit_distance(name, other, least);
        if (distance > least || distance == 0)
            continue;
        best = other;
        least = distance - 1;
    }
    if (best)
        snprintf(buffer, size, "did you mean '%s'?", best);
    return best ? buffer : NULL;
}
