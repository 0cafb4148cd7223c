/* SPDX-License-Identifier: MIT
 * Names that are not supported yet, and arguments that cannot be used; see builtins.h.
 */
#include "lang/evaluate/builtins.h"

#include <string.h>

#include "base/scene_codes.h"

typedef struct unsupported_row {
    const char *name, *hint;
} unsupported_row;

static const unsupported_row unsupported[] = {
#define CSG_UNSUPPORTED(name, hint) {#name, hint},
#include "lang/evaluate/unsupported_modules.def"
#undef CSG_UNSUPPORTED
};

void csg_unsupported_intern(csg_symbols *symbols, bool *ok)
{
    for (size_t i = 0; i < sizeof unsupported / sizeof *unsupported && *ok; i++) {
        const char *name = unsupported[i].name;
        csg_symbol symbol = csg_symbol_intern(symbols, name, strlen(name));
        *ok = symbol != 0;
        if (symbol)
            symbols->entries[symbol].unsupported = (int16_t)i;
    }
}

bool csg_unsupported_report(csg_eval *e, csg_symbol name, csg_span where)
{
    const csg_symbol_entry *entry = &e->program->symbols.entries[name];
    if (entry->unsupported < 0)
        return false;
    csg_eval_report(e, CSG_DIAG_NOT_SUPPORTED, where, unsupported[entry->unsupported].hint,
                    "%s() is not supported yet%s", entry->name,
                    csg_eval_is_lenient(e, CSG_DIAG_NOT_SUPPORTED, where)
                        ? "; it is left out, with what stands under it"
                        : "");
    return true;
}

csg_value csg_bad_argument(const csg_function_call *call, uint32_t index, const char *wanted)
{
    csg_eval_report(call->e, CSG_DIAG_BAD_ARGUMENT,
                    index < call->count ? call->syntax[index].value->whole : call->where, NULL,
                    "%s() needs %s, not a %s; it counts as undef", call->name, wanted,
                    index < call->count ? csg_value_kind_name(call->arguments[index]) : "nothing");
    return csg_value_undef();
}
