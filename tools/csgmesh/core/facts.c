/* SPDX-License-Identifier: MIT
 * Facts about scenes and meshes; see facts.h.
 */
#include "core/facts.h"

#include <inttypes.h>
#include <math.h>

void cli_facts_scene_json(cli_json *json, const csgm_scene_info *info)
{
    cli_json_count(json, "primitives", info->primitive_count);
    cli_json_count(json, "operators", info->operator_count);
    cli_json_number(json, "lambda", info->lipschitz);
    cli_json_box(json, "bounds", info->bounds);
}

static bool is_manifold(const csgm_mesh_check *check)
{
    return check->boundary_edges == 0 && check->nonmanifold_edges == 0 &&
           check->misoriented_edges == 0 && check->nonmanifold_vertices == 0 &&
           check->degenerate_triangles == 0 && check->index_out_of_range == 0;
}

csgm_file_figures cli_facts_of_mesh(const csgm_mesh_view *view, const csgm_mesh_check *check)
{
    csgm_file_figures mesh = csgm_file_figures_default();
    mesh.vertices = view->vertex_count;
    mesh.triangles = view->triangle_count;
    mesh.has_normals = view->normals != NULL;
    mesh.has_colors = view->colors != NULL;
    mesh.check = *check;
    return mesh;
}

void cli_facts_mesh_json(cli_json *json, const csgm_file_figures *mesh)
{
    const csgm_mesh_check *check = &mesh->check;
    cli_json_count(json, "vertices", mesh->vertices);
    cli_json_count(json, "triangles", mesh->triangles);
    cli_json_count(json, "components", check->components);
    cli_json_integer(json, "euler", check->euler);
    if (is_manifold(check))
        cli_json_integer(json, "genus", check->genus);
    cli_json_count(json, "boundary_edges", check->boundary_edges);
    cli_json_count(json, "nonmanifold_edges", check->nonmanifold_edges);
    cli_json_count(json, "misoriented_edges", check->misoriented_edges);
    cli_json_count(json, "nonmanifold_vertices", check->nonmanifold_vertices);
    cli_json_count(json, "degenerate_triangles", check->degenerate_triangles);
    cli_json_count(json, "zero_area_triangles", check->zero_area_triangles);
    cli_json_bool(json, "manifold", is_manifold(check));
    cli_json_number(json, "area", check->area);
    cli_json_number(json, "volume", check->volume);
    cli_json_box(json, "bounds", check->bounds);
}

/* Levels of cells that follow the shape, up to the finest that occurs. */
static int levels_of(const csgm_mesh_stats *stats)
{
    int count = CSGM_LEVELS_MOST;
    while (count > 1 && !stats->blocks[count - 1])
        count--;
    return count;
}

static double finest_of(const csgm_mesh_stats *stats)
{
    return ldexp(stats->cell_coarsest, 1 - levels_of(stats));
}

static bool is_adaptive(const csgm_mesh_stats *stats)
{
    return stats->tolerance > 0;
}

/* A mesh of nothing but polyhedra's own triangles, or made of such, has no cells. */
static bool has_cells(const csgm_mesh_stats *stats)
{
    return stats->cell_size > 0 || !(stats->own_triangles || stats->own_triangles_before);
}

static void put_cells(cli_json *json, const csgm_mesh_stats *stats)
{
    bool adaptive = is_adaptive(stats);
    if (adaptive)
        cli_json_number(json, "tolerance", stats->tolerance);
    cli_json_number(json, "cell_coarsest", adaptive ? stats->cell_coarsest : stats->cell_size);
    cli_json_number(json, "cell_finest", adaptive ? finest_of(stats) : stats->cell_size);
    cli_json_open(json, "blocks", '[');
    for (int i = 0; i < (adaptive ? levels_of(stats) : 1); i++)
        cli_json_count(json, NULL, adaptive ? stats->blocks[i] : stats->leaf_blocks);
    cli_json_end(json, ']');
}

void cli_facts_lattice_json(cli_json *json, const csgm_mesh_stats *stats)
{
    cli_json_open(json, "lattice", '{');
    cli_json_bool(json, "adaptive", is_adaptive(stats));
    if (stats->own_triangles)
        cli_json_count(json, "own_triangles", stats->own_triangles);
    if (stats->own_triangles_before)
        cli_json_count(json, "own_triangles_before", stats->own_triangles_before);
    if (has_cells(stats))
        put_cells(json, stats);
    cli_json_end(json, '}');
}

/* ---- for people ------------------------------------------------------------------------ */

static void print_bounds(csgm_box box)
{
    if (box.min.x > box.max.x) {
        printf("  bounds       none: it is empty\n");
        return;
    }
    csgm_vec3 size = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    printf("  bounds       %.9g,%.9g,%.9g to %.9g,%.9g,%.9g\n", box.min.x, box.min.y, box.min.z,
           box.max.x, box.max.y, box.max.z);
    if (isfinite(size.x + size.y + size.z))
        printf("  size         %.9g x %.9g x %.9g\n", size.x, size.y, size.z);
}

void cli_facts_scene_text(const csgm_scene_info *info)
{
    printf("  primitives   %" PRIu32 "\n", info->primitive_count);
    printf("  operators    %" PRIu32 "\n", info->operator_count);
    printf("  lambda       %.9g\n", info->lipschitz);
    printf("  colours      %s\n", info->has_colors ? "yes" : "no");
    print_bounds(info->bounds);
}

void cli_facts_lattice_text(const csgm_mesh_stats *stats)
{
    if (stats->own_triangles)
        printf("%" PRIu64 " triangles of its mesh are those of polyhedra, as they are\n",
               stats->own_triangles);
    if (stats->own_triangles_before)
        printf("its mesh was made of %" PRIu64 " triangles of polyhedra\n",
               stats->own_triangles_before);
    if (!has_cells(stats))
        return;
    if (is_adaptive(stats))
        printf("its mesh within %.9g, of cells of %.9g to %.9g\n", stats->tolerance,
               stats->cell_coarsest, finest_of(stats));
    else
        printf("its mesh with cells of %.9g\n", stats->cell_size);
}

static void print_fault(uint64_t count, const char *what, const char **separator)
{
    if (!count)
        return;
    printf("%s%" PRIu64 " %s", *separator, count, what);
    *separator = ", ";
}

static void print_soundness(const csgm_mesh_check *check)
{
    const char *separator = "no: ";
    printf("  closed       ");
    if (is_manifold(check)) {
        printf("yes, an oriented 2-manifold\n");
        return;
    }
    print_fault(check->boundary_edges, "boundary edges", &separator);
    print_fault(check->nonmanifold_edges, "edges used more than twice", &separator);
    print_fault(check->misoriented_edges, "edges with triangles turned against each other",
                &separator);
    print_fault(check->nonmanifold_vertices, "vertices with several fans", &separator);
    print_fault(check->degenerate_triangles, "degenerate triangles", &separator);
    print_fault(check->index_out_of_range, "indices out of range", &separator);
    putchar('\n');
}

void cli_facts_mesh_text(const csgm_file_figures *mesh)
{
    const csgm_mesh_check *check = &mesh->check;
    printf("  vertices     %" PRIu64 "%s%s\n", mesh->vertices,
           mesh->has_normals ? ", with normals" : "", mesh->has_colors ? ", with colours" : "");
    printf("  triangles    %" PRIu64 "\n", mesh->triangles);
    print_bounds(check->bounds);
    printf("  area         %.9g\n", check->area);
    printf("  volume       %.9g%s\n", check->volume,
           check->boundary_edges ? " (of an open mesh)" : "");
    printf("  components   %" PRIu64 "\n", check->components);
    printf("  euler        %" PRId64 "\n", check->euler);
    if (is_manifold(check))
        printf("  genus        %" PRId64 "\n", check->genus);
    print_soundness(check);
    printf("  min angle    %.4g degrees\n", check->min_angle_deg);
    if (check->zero_area_triangles)
        printf("  zero area    %" PRIu64 " triangles\n", check->zero_area_triangles);
    if (check->unused_vertices)
        printf("  unused       %" PRIu64 " vertices\n", check->unused_vertices);
}
