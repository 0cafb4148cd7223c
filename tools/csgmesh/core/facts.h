/* SPDX-License-Identifier: MIT
 * What is known about scenes and meshes, as members of a JSON object or as lines for people.
 */
#ifndef CLI_FACTS_H
#define CLI_FACTS_H

#include "core/json.h"

/* "primitives", "operators", "lambda", "bounds" of the open object. */
void cli_facts_scene_json(cli_json *json, const csgm_scene_info *info);
/* "vertices" ... "bounds" of the open object. */
void cli_facts_mesh_json(cli_json *json, const csgm_file_figures *mesh);

/* "lattice": cells of one size or such as follow the shape, and how many of which size; triangles
 * that went into the mesh as they are. */
void cli_facts_lattice_json(cli_json *json, const csgm_mesh_stats *stats);

void cli_facts_scene_text(const csgm_scene_info *info);
void cli_facts_lattice_text(const csgm_mesh_stats *stats);
void cli_facts_mesh_text(const csgm_file_figures *mesh);

/* The same of a mesh in memory. */
csgm_file_figures cli_facts_of_mesh(const csgm_mesh_view *view, const csgm_mesh_check *check);

#endif
