/* SPDX-License-Identifier: MIT
 * What a comparison looks like: both meshes in one frame, what their distances are as colours, from
 * where the change is best seen. The picture and the page both draw this.
 */
#ifndef CLI_DIFF_DRAWING_H
#define CLI_DIFF_DRAWING_H

#include "diff/diff_fine.h"
#include "diff/diff_result.h"
#include "diff/diff_side.h"

typedef struct diff_drawing {
    csgm_mesh_view sides[2];   /* B turned, where the comparison turned it */
    const float *distances[2]; /* per vertex, borrowed; NULL: not measured */
    csgm_box box;              /* of both; a unit cube when both are empty */
    double most;               /* the distance that is dark red; 0: nothing differs */
    csgm_vec3 toward;          /* unit vector from the middle toward the eye */
    csgm_context *context;
    float *turned;        /* own memory of sides[1].positions, or NULL */
    diff_fine fine[2];    /* and of sides, where their triangles are large for a picture */
    csgm_diff *fine_diff; /* whose distances those of fine sides are, or NULL */
} diff_drawing;

/* False: out of memory (reported). The diff and the sides must outlive it. */
bool diff_drawing_make(cli_app *app, const csgm_diff *diff, const diff_side sides[2],
                       diff_drawing *out);
void diff_drawing_release(diff_drawing *drawing);
csgm_vec3 diff_drawing_vertex(const csgm_mesh_view *view, uint32_t vertex);
/* Whether A's triangle is far enough from B to be shown where B is: the heat map has both. */
bool diff_drawing_shows(const diff_drawing *drawing, uint64_t triangle_of_a);
/* The largest distance of both directions whose place is in sight from the eye, if it is at least
 * half of the largest at all; else NULL. */
const csgm_diff_place *diff_drawing_worst_seen(const diff_drawing *drawing,
                                               const csgm_diff_report *report, csgm_vec3 eye);

#endif
