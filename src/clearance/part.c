/* SPDX-License-Identifier: MIT
 * See part.h.
 */
#include "clearance/part.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "base/table.h"
#include "field/field.h"
#include "scene/tree/print.h"

static csgm_status refuse_unbounded(csgm_context *context, const char *name)
{
    csg_diag_plain(&context->diags, CSG_DIAG_UNBOUNDED, NULL, "intersect it with a cube",
                   "%s%.80s%s reaches to infinity, so nothing can be said to be clear of it",
                   name ? "part \"" : "the part without a name", name ? name : "",
                   name ? "\"" : "");
    return CSGM_ERR_SCENE;
}

static void hash_text(void *user, const char *text, size_t length)
{
    csg_digest_text(user, text, length);
}

/* The text that the scene can be made from again: two with the same text are the same. */
static csgm_status find_digest(const csgm_scene *scene, uint64_t digest[2])
{
    digest[0] = CSG_HASH_START;
    digest[1] = 0;
    return csg_scene_print(scene, hash_text, digest);
}

static csgm_status compile(csg_clear_part *part, csgm_context *context, const char *name,
                           csg_mesh_watch *watch)
{
    csgm_status status = csg_field_compile(context, part->scene, &part->field);
    if (status != CSGM_OK || csg_box_is_empty(part->field->bounds))
        return status;
    if (!csg_box_is_finite(part->field->bounds))
        return refuse_unbounded(context, name);
    part->is_open = true;
    return csg_measure_walk_open(&part->walk, context, part->field, watch)
               ? CSGM_OK
               : csg_context_no_memory(context);
}

csgm_status csg_clear_part_take(csg_clear_part *part, csgm_context *context, const csg_parts *parts,
                                size_t index, csg_mesh_watch *watch, bool *changed)
{
    csg_clear_part fresh = {.scene = NULL};
    csgm_status status = csg_parts_scene(parts, index, &fresh.scene);
    if (status == CSGM_OK) {
        fresh.scene->texts = NULL; /* they go with the pose's scene */
        fresh.scene->text_count = 0;
        status = find_digest(fresh.scene, fresh.digest);
    }
    if (status == CSGM_ERR_MEMORY)
        csg_context_no_memory(context);
    *changed = !part->field || memcmp(fresh.digest, part->digest, sizeof fresh.digest) != 0;
    if (status == CSGM_OK && *changed) {
        csg_clear_part_release(part);
        *part = fresh;
        return compile(part, context, csg_parts_name(parts, index), watch);
    }
    csg_clear_part_release(&fresh);
    return status;
}

void csg_clear_part_release(csg_clear_part *part)
{
    if (part->is_open)
        csg_measure_walk_release(&part->walk);
    csg_field_destroy(part->field);
    csg_scene_destroy(part->scene);
    memset(part, 0, sizeof *part);
}
