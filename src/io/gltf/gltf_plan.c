/* SPDX-License-Identifier: MIT
 * Shapes and nodes -> the tables of a glTF document with a plain buffer; see gltf_plan.h. glTF is Y
 * up and in metres: the root's matrix turns and scales, what stands in it is only moved, by numbers
 * in scene units. So the floats stay those of the mesh, and a reader that divides the matrix by the
 * scale gets the scene's coordinates to the bit.
 */
#include "io/gltf/gltf_plan.h"

#include <math.h>

#include "io/units.h"

/* Where metallic and roughness change over a part, they are the coordinates of a vertex in this
 * texture of 2 x 2 pixels: green is roughness, from 0 above to 1 below, and blue is metallic, from
 * 0 at the left to 1 at the right, so that what the viewer interpolates between their centres is
 * the mixture itself. A PNG, padded to four bytes. */
const uint8_t csg_gltf_mixing_texture[CSG_GLTF_MIXING_BYTES] = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xFD,
    0xD4, 0x9A, 0x73, 0x00, 0x00, 0x00, 0x0F, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0x60,
    0x00, 0x81, 0xFF, 0x10, 0xF4, 0x1F, 0x00, 0x0F, 0xFE, 0x03, 0xFD, 0x4B, 0x85, 0x65, 0xCA,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

void csg_gltf_unit_normal(const float n[3], float out[3])
{
    float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    float scale = 1;
    if (!(fabsf(square - 1) < 1e-4f)) { /* the format's validator allows 0.7 % of length */
        scale = square > 0 && isfinite(square) ? 1 / sqrtf(square) : 0;
        if (scale == 0 || !isfinite(scale)) {
            out[0] = out[1] = 0;
            out[2] = 1;
            return;
        }
    }
    for (int k = 0; k < 3; k++)
        out[k] = n[k] * scale;
}

bool csg_gltf_is_mixed(const csg_gltf_source *source)
{
    for (size_t i = 0; i < source->shape_count; i++)
        if (source->shapes[i].look.each_material)
            return true;
    return false;
}

/* ---- nodes -----------------------------------------------------------------------------------
 */

/* Columns of scale * rotation; the rotation takes (x, y, z) to (x, z, -y). */
static void set_matrix(csg_gltf_document *document)
{
    double s = csg_unit_metres(document->options->unit), *m = document->matrix;
    memset(m, 0, sizeof document->matrix);
    m[0] = s;
    m[15] = 1;
    if (document->options->y_up) {
        m[6] = -s;
        m[9] = s;
    } else {
        m[5] = m[10] = s;
    }
}

/* scales and shifts: of what stands in each mesh's buffer; NULL = 1 and 0. */
typedef struct frames {
    const double *scales;
    const csgm_vec3 *shifts;
} frames;

static void add_show(csg_gltf_document *document, const csg_gltf_show *show, const frames *f,
                     int parent)
{
    csg_gltf_node node = {.mesh = (int)show->shape,
                          .parent = parent,
                          .name = show->name,
                          .more = show->more,
                          .scale = f->scales ? f->scales[show->shape] : 1};
    csgm_vec3 shift = f->shifts ? f->shifts[show->shape] : (csgm_vec3){0, 0, 0};
    node.translation[0] = show->shift.x + shift.x;
    node.translation[1] = show->shift.y + shift.y;
    node.translation[2] = show->shift.z + shift.z;
    csg_gltf_add_node(document, node);
}

/* One thing that is not moved is the root itself. */
static void add_level(csg_gltf_document *document, const csg_gltf_show *shows, size_t count,
                      const frames *f)
{
    const csgm_write_options *options = document->options;
    csg_gltf_node root = {
        .mesh = CSG_GLTF_NONE, .parent = CSG_GLTF_NONE, .matrix = document->matrix, .scale = 1};
    uint32_t level = shows->level;
    if (level)
        root.level = &options->levels[level - 1];
    bool alone = count == 1 && !f->scales && shows->shift.x == 0 && shows->shift.y == 0 &&
                 shows->shift.z == 0;
    if (alone) {
        root.mesh = (int)shows->shape;
        root.name = shows->name;
    }
    int parent = csg_gltf_add_node(document, root);
    for (size_t i = 0; i < count && !alone; i++)
        add_show(document, &shows[i], f, parent);
}

/* The part of the picture's height that the solid has where the next level is a pixel of a thousand
 * off; the last level is shown however small it is. */
static void choose_coverage(csg_gltf_document *document, const csg_gltf_source *source)
{
    const csgm_write_options *options = document->options;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < source->shape_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)source->shapes[i].min[k]);
            high[k] = fmax(high[k], (double)source->shapes[i].max[k]);
        }
    double size =
        sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]) +
             (high[2] - low[2]) * (high[2] - low[2]));
    for (size_t i = 0; i < options->level_count; i++) {
        double error = options->levels[i].error, most = i ? document->coverage[i - 1] : 1;
        double wanted = error > 0 ? size / (1000 * error) : 1;
        document->coverage[i] = fmin(most, floor(wanted * 1000 + 0.5) / 1000);
    }
    document->coverage[options->level_count] = 0;
}

void csg_gltf_add_nodes(csg_gltf_document *document, const csg_gltf_source *source,
                        const double *scales, const csgm_vec3 *shifts)
{
    const frames f = {scales, shifts};
    set_matrix(document);
    document->level_count = (uint32_t)document->options->level_count + 1;
    for (size_t i = 0, end; i < source->show_count; i = end) {
        for (end = i + 1; end < source->show_count;)
            if (source->shows[end].level == source->shows[i].level)
                end++;
            else
                break;
        add_level(document, &source->shows[i], end - i, &f);
    }
    choose_coverage(document, source);
}

csg_gltf_mesh csg_gltf_new_mesh(csg_gltf_document *document, const csg_gltf_shape *shape)
{
    const int none = CSG_GLTF_NONE;
    return (csg_gltf_mesh){.name = shape->name,
                           .position = none,
                           .normal = none,
                           .color = none,
                           .mixing = none,
                           .uv = none,
                           .indices = none,
                           .manifold = none,
                           .merge_places = none,
                           .merge_values = none,
                           .draco_view = none,
                           .material = csg_gltf_add_material(document, &shape->look)};
}

/* ---- the buffer ------------------------------------------------------------------------------
 */

static uint64_t index_bytes(const csg_gltf_shape *shape)
{
    return csg_gltf_padded(shape->index_count * (csg_gltf_is_short(shape) ? 2 : 4));
}

static uint64_t merge_bytes(const csg_gltf_shape *shape)
{
    return csg_gltf_padded(shape->merge_count * csg_gltf_place_bytes(shape)) +
           csg_gltf_padded(shape->merge_count * (csg_gltf_is_short(shape) ? 2 : 4));
}

csg_gltf_sections csg_gltf_place_sections(csg_gltf_source *source)
{
    const csgm_mesh_view *mesh = &source->mesh;
    csg_gltf_shape *shapes = source->shapes;
    csg_gltf_sections s = {.normals = 12 * mesh->vertex_count};
    uint64_t at = s.indices = s.normals + (mesh->normals ? 12 * mesh->vertex_count : 0);
    for (size_t i = 0; i < source->shape_count; at += index_bytes(&shapes[i++]))
        shapes[i].index_at = at;
    s.merges = at;
    for (size_t i = 0; i < source->shape_count; at += merge_bytes(&shapes[i++]))
        shapes[i].merge_at = at;
    s.colors = at;
    for (size_t i = 0; i < source->shape_count; i++) {
        shapes[i].color_at = at;
        at += shapes[i].look.each_color ? 8 * shapes[i].vertex_count : 0;
    }
    s.mixing = at;
    for (size_t i = 0; i < source->shape_count; i++) {
        shapes[i].mixing_at = at;
        at += shapes[i].look.each_material ? 4 * shapes[i].vertex_count : 0;
    }
    s.uv = at;
    s.image = s.uv + (source->uv ? 8 * mesh->vertex_count : 0);
    s.end = s.image + (csg_gltf_is_mixed(source) ? CSG_GLTF_MIXING_BYTES : 0);
    return s;
}

/* ---- tables ----------------------------------------------------------------------------------
 */

typedef struct plan {
    csg_gltf_document *document;
    const csg_gltf_source *source;
    const csg_gltf_sections *sections;
    int positions, normals, indices, merges, colors, mixing, uv; /* views */
} plan;

/* Views of one accessor need no stride. */
static int add_view(const plan *p, uint64_t begin, uint64_t end, uint32_t stride, uint32_t target)
{
    if (begin == end)
        return CSG_GLTF_NONE;
    return csg_gltf_add_view(p->document,
                             (csg_gltf_view){.offset = begin,
                                             .bytes = end - begin,
                                             .stride = p->source->shape_count > 1 ? stride : 0,
                                             .target = target});
}

static void add_views(plan *p)
{
    const csg_gltf_sections *s = p->sections;
    p->positions = add_view(p, 0, s->normals, 12, CSG_GLTF_VERTICES);
    p->normals = add_view(p, s->normals, s->indices, 12, CSG_GLTF_VERTICES);
    p->indices = add_view(p, s->indices, s->merges, 0, CSG_GLTF_INDICES);
    p->merges = add_view(p, s->merges, s->colors, 0, 0);
    p->colors = add_view(p, s->colors, s->mixing, 8, CSG_GLTF_VERTICES);
    p->mixing = add_view(p, s->mixing, s->uv, 4, CSG_GLTF_VERTICES);
    p->uv = add_view(p, s->uv, s->image, 8, CSG_GLTF_VERTICES);
    p->document->image_view = add_view(p, s->image, s->end, 0, 0);
    p->document->buffer_bytes = s->end;
}

static int add_vertices(const plan *p, int view, uint64_t at, int component, uint64_t count,
                        const char *type)
{
    return csg_gltf_add_accessor(p->document,
                                 (csg_gltf_accessor){.view = view,
                                                     .offset = at,
                                                     .component = component,
                                                     .normalized = component != CSG_GLTF_FLOAT,
                                                     .count = count,
                                                     .type = type});
}

static int add_positions(const plan *p, const csg_gltf_shape *shape)
{
    csg_gltf_accessor a = {.view = p->positions,
                           .offset = 12 * shape->first_vertex,
                           .component = CSG_GLTF_FLOAT,
                           .count = shape->vertex_count,
                           .type = "VEC3",
                           .has_range = true};
    for (int k = 0; k < 3; k++) {
        a.min[k] = (double)shape->min[k];
        a.max[k] = (double)shape->max[k];
    }
    return csg_gltf_add_accessor(p->document, a);
}

static int add_indices(const plan *p, int view, uint64_t at, uint64_t count, bool is_short)
{
    return csg_gltf_add_accessor(
        p->document,
        (csg_gltf_accessor){.view = view,
                            .offset = at,
                            .component = is_short ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_INT,
                            .count = count,
                            .type = "SCALAR"});
}

/* The indices again, with those that name another vertex of their place. */
static void add_manifold(const plan *p, const csg_gltf_shape *shape, csg_gltf_mesh *mesh)
{
    uint64_t at = shape->merge_at - p->sections->merges, place = csg_gltf_place_bytes(shape);
    bool is_short = csg_gltf_is_short(shape);
    mesh->merge_places = add_indices(p, p->merges, at, shape->merge_count, place == 2);
    at += csg_gltf_padded(shape->merge_count * place);
    mesh->merge_values = add_indices(p, p->merges, at, shape->merge_count, is_short);
    mesh->manifold = csg_gltf_add_accessor(
        p->document,
        (csg_gltf_accessor){.view = p->indices,
                            .offset = shape->index_at - p->sections->indices,
                            .component = is_short ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_INT,
                            .count = shape->index_count,
                            .type = "SCALAR",
                            .sparse_count = shape->merge_count,
                            .sparse_places = mesh->merge_places,
                            .sparse_values = mesh->merge_values});
}

static void add_shape(const plan *p, const csg_gltf_shape *shape)
{
    uint64_t first = shape->first_vertex, count = shape->vertex_count;
    csg_gltf_mesh mesh = csg_gltf_new_mesh(p->document, shape);
    mesh.position = add_positions(p, shape);
    if (p->source->mesh.normals)
        mesh.normal = add_vertices(p, p->normals, 12 * first, CSG_GLTF_FLOAT, count, "VEC3");
    if (shape->look.each_color)
        mesh.color = add_vertices(p, p->colors, shape->color_at - p->sections->colors,
                                  CSG_GLTF_UNSIGNED_SHORT, count, "VEC4");
    if (shape->look.each_material)
        mesh.mixing = add_vertices(p, p->mixing, shape->mixing_at - p->sections->mixing,
                                   CSG_GLTF_UNSIGNED_SHORT, count, "VEC2");
    if (p->source->uv)
        mesh.uv = add_vertices(p, p->uv, 8 * first, CSG_GLTF_FLOAT, count, "VEC2");
    mesh.indices = add_indices(p, p->indices, shape->index_at - p->sections->indices,
                               shape->index_count, csg_gltf_is_short(shape));
    if (shape->merge_count)
        add_manifold(p, shape, &mesh);
    csg_gltf_add_mesh(p->document, mesh);
}

void csg_gltf_plan(csg_gltf_document *document, const csg_gltf_source *source,
                   const csg_gltf_sections *sections)
{
    plan p = {.document = document, .source = source, .sections = sections};
    add_views(&p);
    for (size_t i = 0; i < source->shape_count; i++)
        add_shape(&p, &source->shapes[i]);
    csg_gltf_add_nodes(document, source, NULL, NULL);
}
