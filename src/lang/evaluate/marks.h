/* SPDX-License-Identifier: MIT
 * What # and % stand before, for pictures. A mark is a node in the frame of the statement that is
 * being run, on a stack beside that of the parts: modules that move their children move the marks
 * that were made among them, those that make something else of their children drop them.
 */
#ifndef CSG_LANG_MARKS_H
#define CSG_LANG_MARKS_H

#include "lang/evaluate/evaluator.h"

/* Marks the parts from `first` on. */
void csg_marks_add(csg_eval *e, size_t first_part, csgm_mark kind, csg_span where);
/* Moves the marks from `first` on; they become at most one a kind and dimension. */
void csg_marks_move(csg_eval *e, size_t first, const csg_affine *by, csg_span where);
/* Takes the marks from `first` on away: a solid for each kind, NONE for none. */
void csg_marks_take(csg_eval *e, size_t first, csg_span where, csg_node_id out[CSGM_MARK_COUNT]);

#endif
