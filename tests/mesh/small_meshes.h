/* SPDX-License-Identifier: MIT
 * Meshes whose counts are known by hand.
 */
#ifndef TEST_SMALL_MESHES_H
#define TEST_SMALL_MESHES_H

#include <stdint.h>
#include <string.h>

/* A unit cube, corners numbered by bits x y z, outward. */
static const float cube_positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0,
                                       0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
static const uint32_t cube_indices[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                        2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
static const float tetra_positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t tetra_indices[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

/* Two tetrahedra with one vertex in common: one vertex with two fans. */
static inline void small_touching_tetrahedra(float positions[21], uint32_t indices[24])
{
    memcpy(positions, tetra_positions, sizeof tetra_positions);
    for (int i = 3; i < 12; i++)
        positions[9 + i] = -tetra_positions[i];
    for (int i = 0; i < 12; i++) {
        indices[i] = tetra_indices[i];
        /* the mirror image, turned round again */
        indices[12 + i] = tetra_indices[11 - i] ? tetra_indices[11 - i] + 3 : 0;
    }
}

#endif
