/* SPDX-License-Identifier: MIT
 * Seeded random scenes for property tests: every primitive (primitives.def; partial tori too),
 * every operator, every blend with widths that matter, unequal scales, sometimes colours. The
 * solids are finite, most of them lie within about [-2, 2]^3; a few are empty.
 */
#ifndef TEST_RANDOM_SCENE_H
#define TEST_RANDOM_SCENE_H

#include "base/random.h"
#include "rounds.h"
#include "scene/tree/build.h"

/* A scene of about that many primitives (>= 1); CSG_NODE_NONE when the builder failed. */
csg_node_id test_random_scene(csg_scene_builder *builder, csg_random *random, unsigned primitives);

/* Whether a quarter of the leaves are extrusions, revolutions, twisted and bent solids, offsets
 * and slices. Off at first: the numbers drawn are then the same as without them. */
extern bool test_random_shapes;

/* Whether figures of these are stars of many segments. Off at first. */
extern bool test_random_outlines;

/* Whether a third of the blends are rules of every kind, a third of the leaves soft, and some
 * leaves superellipsoids. Off at first, too. */
extern bool test_random_rules;

/* Whether one in eight leaves is a tube along a Bezier curve. Off at first, too.
 */
extern bool test_random_curves;

/* Whether most blends are fillets, which no formula of their operands' values says. Off at first.
 */
extern bool test_random_fillets;

/* The i-th of scenes that take turns with these, 1 to 5 primitives each; it leaves them set. */
csg_node_id test_random_mixed(csg_scene_builder *builder, csg_random *random, uint64_t i);

/* One such solid, finite, not placed. */
csg_node_id test_random_shaped(csg_scene_builder *builder, csg_random *random);

/* One of the bounded solids that are exact distances. */
csg_primitive_kind test_random_solid_kind(csg_random *random);
/* A primitive of this kind with random parameters (its example), not placed; they are also copied
 * to `parameters` (room for CSG_PRIMITIVE_MOST_PARAMETERS) unless that is NULL. */
csg_node_id test_random_primitive(csg_scene_builder *builder, csg_random *random,
                                  csg_primitive_kind kind, double *parameters);
void test_random_parameters(csg_random *random, csg_primitive_kind kind, double *parameters);

/* A turn about a random axis after a scale, its three factors between low and high (equal when
 * low = high), then a shift of at most `shift` along each axis. */
csg_affine test_random_affine(csg_random *random, double low, double high, double shift);

/* How far the root's value may be from a field with the scene's Lipschitz constant: fillets lie
 * between their largest operand and that plus an excess, whatever gradients do. INFINITY: not
 * known, what is soft or combined by a formula has one below it. */
double test_waver(const csgm_scene *scene);

/* With bulge elimination, whose share in gradients is left out (scene/operators/operators.def). */
bool test_has_debulge(const csgm_scene *scene);
/* Longer searches with other seeds (tools/soak): the arguments TIMES and SEED of a test program.
 * Each loop goes through so many times as many scenes; seeds begin where those of another SEED end.
 */
extern unsigned test_times;
extern uint64_t test_first_seed;
void test_take_search(int argc, char **argv);

#endif
