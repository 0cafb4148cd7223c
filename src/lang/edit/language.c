/* SPDX-License-Identifier: MIT
 * The tables of modules and functions as rows of names; see language.h.
 */
#include "lang/edit/language.h"

#include <string.h>

#include "lang/parse/ast.h"

typedef struct module_row {
    const char *name, *doc;
    bool takes_children;
} module_row;

static const module_row modules[] = {
#define CSG_MODULE(name, handler, children, doc) {#name, doc, (children) != 0},
#define CSG_CONTROL(name, handler, children, doc) {#name, doc, (children) != 0},
#include "lang/modules/modules.def"
#undef CSG_MODULE
#undef CSG_CONTROL
};

static const struct {
    const char *module, *name, *otherwise, *unit, *range, *doc;
    bool named;
} parameters[] = {
#define POSITIONAL false
#define NAMED true
#define CSG_PARAMETER(module, name, how, otherwise, unit, range, doc)                              \
    {#module, #name, otherwise, unit, range, doc, how},
#include "lang/modules/modules.def"
#undef CSG_PARAMETER
};

static const struct {
    const char *name, *parameters, *doc;
} functions[] = {
#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc) {#name, parameters, doc},
#include "lang/functions/functions.def"
#undef CSG_FUNCTION
};

static const struct {
    const char *name, *doc;
} variables[] = {
    {"PI", "3.14159..., half of a full turn in radians"},
    {"$fn", "number of sides of round solids; 0: $fa and $fs decide"},
    {"$fa", "smallest angle of a side of a round solid, in degrees"},
    {"$fs", "smallest length of a side of a round solid"},
    {"$t", "time of an animation, 0"},
    {"$children", "number of children of the module that is running"},
    {"$preview", "false: meshes are made in full"},
    {"$vpr", "rotation of OpenSCAD's view"},
    {"$vpt", "centre of OpenSCAD's view"},
    {"$vpd", "distance of OpenSCAD's view"},
    {"$vpf", "angle of OpenSCAD's view"},
};

static const char *const keywords[] = {"module", "function", "include", "use",   "if",
                                       "else",   "each",     "true",    "false", "undef"};

enum {
    MODULES = sizeof modules / sizeof *modules,
    PARAMETERS = sizeof parameters / sizeof *parameters,
    FUNCTIONS = sizeof functions / sizeof *functions,
    VARIABLES = sizeof variables / sizeof *variables,
    KEYWORDS = sizeof keywords / sizeof *keywords
};

const char *csg_language_row(uint32_t row, csgm_name_kind *kind)
{
    *kind = CSGM_NAME_MODULE;
    if (row < MODULES)
        return modules[row].name;
    row -= MODULES;
    *kind = CSGM_NAME_FUNCTION;
    if (row < FUNCTIONS)
        return functions[row].name;
    row -= FUNCTIONS;
    *kind = CSGM_NAME_VARIABLE;
    if (row < VARIABLES)
        return variables[row].name;
    row -= VARIABLES;
    *kind = CSGM_NAME_KEYWORD;
    return row < KEYWORDS ? keywords[row] : NULL;
}

bool csg_signature_add(csg_arena *arena, csgm_name *name, size_t begin, size_t end)
{
    void *items = (void *)name->parameters;
    csgm_text_range *place = csg_arena_push(arena, &items, &name->parameter_count, sizeof *place);
    if (!place)
        return false;
    *place = (csgm_text_range){(uint32_t)begin, (uint32_t)end};
    name->parameters = items;
    return true;
}

static bool describe_module(csg_arena *arena, const module_row *module, csgm_name *out)
{
    const char *words = module->doc;
    out->takes_children = module->takes_children;
    const char *signature = csg_arena_printf(arena, "module %s(", module->name);
    for (size_t i = 0; i < PARAMETERS && signature && words; i++) {
        if (strcmp(parameters[i].module, module->name) != 0)
            continue;
        const char *otherwise = parameters[i].otherwise, *unit = parameters[i].unit;
        const char *range = parameters[i].range, *comma = out->parameter_count ? ", " : "";
        bool has_default = *otherwise || parameters[i].named;
        size_t begin = strlen(signature) + strlen(comma);
        signature = csg_arena_printf(arena, "%s%s%s%s%s", signature, comma, parameters[i].name,
                                     has_default ? " = " : "", otherwise);
        if (!signature || !csg_signature_add(arena, out, begin, strlen(signature)))
            return false;
        words = csg_arena_printf(arena, "%s\n- `%s`: %s%s%s%s%s%s", words, parameters[i].name,
                                 parameters[i].doc, *unit || *range ? " (" : "", unit,
                                 *unit && *range ? ", " : "", range, *unit || *range ? ")" : "");
    }
    out->signature = signature ? csg_arena_printf(arena, "%s)", signature) : NULL;
    out->documentation = words;
    return out->signature && words;
}

/* The index-th of "a, b = 1, [[key, value], ...]" and its length; NULL: there are not so many. */
static const char *nth_of_list(const char *list, uint32_t index, size_t *length)
{
    for (;; index--) {
        int depth = 0;
        list += strspn(list, " ");
        for (*length = 0; list[*length] && (list[*length] != ',' || depth > 0); ++*length) {
            depth += list[*length] == '[' || list[*length] == '(';
            depth -= list[*length] == ']' || list[*length] == ')';
        }
        if (index == 0 || !list[*length])
            break;
        list += *length + 1;
    }
    return index == 0 && *length ? list : NULL;
}

static bool describe_function(csg_arena *arena, const char *name, const char *list, csgm_name *out)
{
    size_t length, ahead = strlen("function (") + strlen(name);
    bool ok = true;
    const char *item;
    for (uint32_t i = 0; ok && (item = nth_of_list(list, i, &length)); i++) {
        size_t begin = ahead + (size_t)(item - list);
        ok = csg_signature_add(arena, out, begin, begin + length);
    }
    out->signature = csg_arena_printf(arena, "function %s(%s)", name, list);
    return ok && out->signature;
}

bool csg_language_describe(csg_arena *arena, uint32_t row, csgm_name *out)
{
    if (row < MODULES)
        return describe_module(arena, &modules[row], out);
    row -= MODULES;
    if (row < FUNCTIONS) {
        out->documentation = functions[row].doc;
        return describe_function(arena, functions[row].name, functions[row].parameters, out);
    }
    row -= FUNCTIONS;
    out->signature = row < VARIABLES ? variables[row].name : keywords[row - VARIABLES];
    out->documentation = row < VARIABLES ? variables[row].doc : NULL;
    return true;
}

const char *csg_language_parameter(csg_arena *arena, uint32_t row, uint32_t index,
                                   const char **documentation)
{
    *documentation = NULL;
    if (row >= MODULES) {
        row -= MODULES;
        size_t length;
        const char *item =
            row < FUNCTIONS ? nth_of_list(functions[row].parameters, index, &length) : NULL;
        return item ? csg_arena_strndup(arena, item, length) : NULL;
    }
    for (size_t i = 0; i < PARAMETERS; i++)
        if (strcmp(parameters[i].module, modules[row].name) == 0 && index-- == 0) {
            *documentation = parameters[i].doc;
            return parameters[i].name;
        }
    return NULL;
}
