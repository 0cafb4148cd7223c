/* SPDX-License-Identifier: MIT
 * JSON for the library's customers: the reader of parameter sets, with its findings as diagnostics.
 */
#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "csgmesh/csgmesh.h"
#include "text/json.h"
#include "text/source.h"

typedef struct listener {
    csgm_json_fn *event;
    void *user;
} listener;

static bool pass_on(void *user, csg_json_kind kind, const char *text, size_t length)
{
    static const csgm_json_kind kinds[] = {
        [CSG_JSON_OBJECT] = CSGM_JSON_OBJECT, [CSG_JSON_ARRAY] = CSGM_JSON_ARRAY,
        [CSG_JSON_END] = CSGM_JSON_END,       [CSG_JSON_KEY] = CSGM_JSON_KEY,
        [CSG_JSON_STRING] = CSGM_JSON_STRING, [CSG_JSON_NUMBER] = CSGM_JSON_NUMBER,
        [CSG_JSON_WORD] = CSGM_JSON_WORD};
    const listener *l = user;
    return l->event(l->user, kinds[kind], text, length);
}

/* The line with a caret, as for scenes. */
static csgm_status report_broken(csgm_context *context, const char *text, size_t length,
                                 const char *name, const csg_json_error *error)
{
    csg_arena arena;
    csg_sources sources;
    uint32_t source;
    csg_arena_init(&arena, &context->memory);
    csg_sources_init(&sources, context, &arena);
    csgm_status status = csg_source_add(&sources, name, text, length, &source);
    if (status == CSGM_OK) {
        size_t offset = error->offset < length ? error->offset : length;
        csg_source_report(&sources, CSG_DIAG_PARAMETER_FILE,
                          (csg_span){source, (uint32_t)offset, 1}, NULL, "not JSON: %s",
                          error->text);
        status = CSGM_ERR_SYNTAX;
    }
    csg_sources_reset(&sources);
    csg_arena_reset(&arena);
    return status;
}

csgm_status csgm_json_read(csgm_context *context, const char *text, size_t text_length,
                           const char *name, csgm_json_fn *event, void *user)
{
    if (!context || (!text && text_length) || !event)
        return CSGM_ERR_ARGUMENT;
    name = name ? name : "JSON";
    text = text ? text : "";
    if (!csg_json_available()) {
        csg_diag_plain(&context->diags, CSG_DIAG_NO_LIBRARY, name,
                       "install nlohmann-json and build csgmesh again",
                       "this csgmesh was built without the library that reads JSON");
        return CSGM_ERR_UNSUPPORTED;
    }
    listener to = {event, user};
    csg_json_error error;
    csg_json_outcome outcome = csg_json_read(text, text_length, pass_on, &to, &error);
    if (outcome == CSG_JSON_NO_MEMORY)
        return csg_context_no_memory(context);
    return outcome == CSG_JSON_BROKEN ? report_broken(context, text, text_length, name, &error)
                                      : CSGM_OK;
}
