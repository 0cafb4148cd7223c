/* SPDX-License-Identifier: MIT
 * From the polyhedra of a scene to a mesh; see own.h.
 */
#include "mesh/pipeline/own.h"

#include <float.h>
#include <math.h>

#include "base/clock.h"
#include "base/trace.h"
#include "field/field.h"
#include "mesh/own/join.h"
#include "mesh/own/sound.h"
#include "mesh/own/write.h"
#include "mesh/pipeline/own_rests.h"
#include "shape/polyhedra/booleans.h"
#include "shape/polyhedra/polyhedron.h"

typedef struct own {
    csg_mesh_input input;
    csg_mesh_watch watch;
    csg_own_units units;
    csg_own_rests rests;
    csgm_mesh *mesh; /* NULL: they are not taken */
    bool reshapes;   /* it is for changing, not for good */
} own;

/* ---- vertices and triangles --------------------------------------------------------------------
 */

static void paint_vertex(csgm_mesh *mesh, const csg_look *look, size_t vertex)
{
    csg_color color = look->has_color ? look->color : csg_default_color;
    if (mesh->colors) {
        uint8_t *rgba = mesh->colors + 4 * vertex;
        rgba[0] = csg_mesh_color_byte(color.r);
        rgba[1] = csg_mesh_color_byte(color.g);
        rgba[2] = csg_mesh_color_byte(color.b);
        rgba[3] = csg_mesh_color_byte(color.a);
    }
    if (mesh->materials) {
        bool has = look->has_material;
        uint16_t *pair = mesh->materials + 2 * vertex;
        pair[0] = csg_mesh_material_share(has ? look->metallic : csg_default_material.r);
        pair[1] = csg_mesh_material_share(has ? look->roughness : csg_default_material.g);
    }
}

/* The triangles that have a vertex look alike. */
static void paint(const own *o)
{
    const csg_own_units *units = &o->units;
    if (!o->mesh->colors && !o->mesh->materials)
        return;
    for (size_t i = 0; i < units->count; i++) {
        const csg_own_unit *unit = &units->items[i];
        size_t first = unit->first_triangle;
        size_t end = first + csg_polyhedron_triangles(unit->shape)->count;
        for (size_t t = first; t < end; t++) {
            uint32_t look = units->triangle_looks ? units->triangle_looks[t] : unit->look;
            for (size_t k = 0; k < 3; k++)
                paint_vertex(o->mesh, &units->looks[look], o->mesh->indices[3 * t + k]);
        }
    }
}

/* False: a coordinate is too large for a float. */
static bool place_unit(csgm_mesh *mesh, const csg_own_unit *unit)
{
    const csg_triangles *from = csg_polyhedron_triangles(unit->shape);
    bool is_mirrored = csg_affine_determinant(unit->place) < 0;
    double largest = 0;
    for (size_t i = 0; i < from->point_count; i++) {
        size_t vertex = unit->first_vertex + i;
        csg_vec3 at = csg_vec3_sub(csg_affine_point(&unit->place, from->points[i]), mesh->origin);
        largest = fmax(largest, csg_vec3_norm(at));
        if (!(largest < (double)FLT_MAX))
            return false;
        csg_vec3_to_floats(mesh->positions + 3 * vertex, at);
        for (int k = 0; k < 3; k++)
            mesh->positions[3 * vertex + (size_t)k] += 0.0f; /* no -0 */
    }
    for (size_t t = 0; t < from->count; t++)
        for (size_t k = 0; k < 3; k++)
            mesh->indices[3 * (unit->first_triangle + t) + k] =
                unit->first_vertex + from->corners[t][is_mirrored ? 2 - k : k];
    return true;
}

static csgm_status fill(own *o, bool *fits)
{
    csgm_status status =
        csg_mesh_create(o->input.context, o->units.vertex_count, o->units.triangle_count, false,
                        csg_mesh_gets_colors(&o->input), &o->mesh);
    if (status == CSGM_OK && csg_mesh_gets_materials(&o->input))
        status = csg_mesh_add_materials(o->mesh);
    if (status != CSGM_OK)
        return status;
    o->mesh->origin = csg_mesh_origin_of(&o->input);
    *fits = true;
    for (size_t i = 0; i < o->units.count && *fits; i++)
        *fits = place_unit(o->mesh, &o->units.items[i]);
    return CSGM_OK;
}

/* ---- all of it ---------------------------------------------------------------------------------
 */

static void drop(own *o)
{
    csg_mesh_destroy(o->mesh);
    o->mesh = NULL;
}

static csgm_status add_normals(own *o, const csg_corners *corners)
{
    csgm_normals normals = o->input.options->normals;
    csgm_mesh *with;
    if (normals == CSGM_NORMALS_NONE || o->reshapes)
        return CSGM_OK;
    csgm_status status = csg_own_write_normals(
        o->input.context, o->mesh, corners, normals == CSGM_NORMALS_CREASE, o->units.triangle_looks,
        o->rests.count ? csg_own_rests_normal : NULL, &o->rests, &with);
    if (status == CSGM_OK) {
        drop(o);
        o->mesh = with;
    }
    return status;
}

static csgm_status make_mesh(own *o)
{
    bool sound = false;
    csg_corners corners;
    csgm_status status = fill(o, &sound);
    if (!sound)
        drop(o);
    if (status != CSGM_OK || !sound)
        return status;
    csg_corners_result result =
        csg_corners_make(&corners, &o->input.context->memory, o->mesh->indices,
                         o->mesh->triangle_count, o->mesh->vertex_count);
    if (result == CSG_CORNERS_NO_MEMORY)
        return csg_context_no_memory(o->input.context);
    sound = result == CSG_CORNERS_MADE;
    if (!sound) {
        drop(o);
        return CSGM_OK;
    }
    status = csg_own_is_sound(&o->units, o->mesh, &corners, &o->watch, &sound);
    if (status == CSGM_OK && sound)
        status = add_normals(o, &corners);
    if (status == CSGM_OK && sound)
        paint(o);
    csg_corners_release(&corners);
    if (!sound)
        drop(o);
    return status;
}

/* Those of polyhedra. */
static uint64_t count_own(own *o)
{
    const csgm_mesh *mesh = o->mesh;
    uint64_t count = 0;
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        csg_vec3 v[3], normal;
        for (size_t k = 0; k < 3; k++)
            v[k] = csg_vec3_from_floats(mesh->positions + 3 * (size_t)mesh->indices[3 * t + k]);
        csg_vec3 middle = csg_vec3_scale(csg_vec3_add(v[0], csg_vec3_add(v[1], v[2])), 1.0 / 3);
        csg_vec3 face =
            csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0])));
        count += !csg_own_rests_normal(&o->rests, middle, face, &normal);
    }
    return count;
}

static void fill_stats(own *o, csgm_mesh_stats *stats)
{
    *stats = o->rests.stats;
    stats->mesh_s = csg_clock_now_s() - o->watch.started_s - stats->octree_s - stats->reshape_s;
    stats->own_triangles = count_own(o);
    stats->memory_peak_bytes = atomic_load(&o->input.context->memory.peak_bytes);
}

/* Bounds and cells that are no numbers are for the lattice to refuse. */
static bool is_whole(const csg_mesh_input *in)
{
    return !(in->options->cell_size < 0) && !isnan(in->options->cell_size) &&
           csg_box_is_finite(in->bounds) && csg_box_contains_box(in->bounds, in->field->bounds);
}

/* A vertex at the border of two looks is of both, unless there is one for each side. */
static bool can_be_joined(const own *o)
{
    const csg_own_units *units = &o->units;
    bool splits = o->input.options->normals == CSGM_NORMALS_CREASE;
    return units->are_apart || (csg_booleans_are_available() && csg_own_units_have_looks(units) &&
                                (units->look_count == 1 || splits));
}

/* Changes ask for one field, and for one look at a vertex. */
static bool can_be_reshaped(const own *o)
{
    const csg_own_units *units = &o->units;
    return !units->rest_count && (units->are_apart || units->look_count <= 1);
}

static csgm_status build(own *o)
{
    const csgm_mesh_options *options = o->input.options;
    if (!is_whole(&o->input))
        return CSGM_OK;
    csgm_status status = csg_own_units_find(&o->units, o->input.field->scene);
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(o->input.context);
    if (!csg_mesh_gets_colors(&o->input) && !csg_mesh_gets_materials(&o->input))
        csg_own_units_forget_looks(&o->units);
    bool may_be_reshaped = can_be_reshaped(o);
    if (!can_be_joined(o) || (csg_mesh_reshapes_own(options, 0) && !may_be_reshaped))
        return CSGM_OK;
    status = csg_own_rests_mesh(&o->rests, &o->units, &o->input);
    if (status == CSGM_OK)
        status = csg_own_join(&o->units, o->input.field->scene, &o->watch);
    if (status != CSGM_OK)
        return status;
    o->reshapes = csg_mesh_reshapes_own(options, o->units.triangle_count);
    if (!o->units.count || (o->reshapes && !may_be_reshaped))
        return CSGM_OK;
    status = make_mesh(o);
    if (status != CSGM_OK)
        drop(o);
    return status;
}

csgm_status csg_mesh_build_own(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const csg_mesh_share *share,
                               csgm_mesh **out, csgm_mesh_stats *stats)
{
    CSG_ZONE(context, "own triangles");
    own o = {.input = {.context = context, .options = options, .field = field, .share = share}};
    o.input.bounds = csg_box_is_empty(options->bounds) ? field->bounds : options->bounds;
    csg_mesh_input_watch(&o.input, 0, &o.watch);
    o.watch.stage = CSGM_STAGE_MESH;
    csgm_status status = build(&o);
    if (status == CSGM_OK && o.mesh && stats)
        fill_stats(&o, stats);
    csg_own_units_reset(&o.units);
    csg_own_rests_release(&o.rests);
    *out = o.mesh;
    return status;
}
