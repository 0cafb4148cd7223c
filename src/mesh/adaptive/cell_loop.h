/* SPDX-License-Identifier: MIT
 * Parallel loops over leaves: what each makes is joined in the order of the leaves, whatever the
 * number of threads, and of ranks that share them; vertices of edges and faces are found again by
 * their places.
 */
#ifndef CSG_MESH_ADAPTIVE_CELL_LOOP_H
#define CSG_MESH_ADAPTIVE_CELL_LOOP_H

#include "base/table.h"
#include "mesh/adaptive/extraction.h"

/* A vertex and the edge or face that it lies on, by its middle. */
typedef struct csg_placed_vertex {
    uint64_t place;
    float at[3], gradient[3];
    bool is_crease, is_torn;
} csg_placed_vertex;

/* Of an apex, in a triangle: its number in the item, later in the mesh. */
#define CSG_OWN_VERTEX UINT32_C(0x80000000)

/* What one item of a loop made, and where it is. */
typedef struct csg_cell_segment {
    uint32_t worker;
    size_t first, count, first_corner, corner_count;
    uint64_t creases, smooth;
} csg_cell_segment;

typedef struct csg_cell_worker {
    csg_placed_vertex *vertices;
    uint32_t *corners;
    size_t count, capacity, corner_count, corner_capacity;
    size_t first;             /* vertex of the item at hand */
    uint64_t creases, smooth; /* of that item */
} csg_cell_worker;

typedef struct csg_cell_loop {
    csg_extraction *x;
    uint32_t *leaves;
    size_t leaf_count, leaf_capacity;
    csg_shell
        *shells; /* of the leaves, where several loops visit them; NULL: made anew each time */
    size_t shell_count;
    bool has_shells; /* they are made */
    csg_cell_worker *workers;
    uint32_t worker_count;
    csg_cell_segment *segments; /* one per item */
    size_t segment_capacity;
    csg_placed_vertex *vertices; /* joined: of edges, then of faces, then of cells */
    size_t count, capacity;
    csg_table index;   /* of those of edges and faces, by place */
    uint32_t *corners; /* joined */
    size_t corner_count;
    uint64_t creases, smooth;
    bool (*visit)(struct csg_cell_loop *loop, uint32_t worker, const csg_shell *shell);
    double before, amount; /* of the stage's progress */
    atomic_bool any;       /* a cell is wanted divided */
    atomic_bool broken;    /* an edge or face has not what its cells expect of it */
} csg_cell_loop;

typedef bool csg_visit_brick(csg_cell_loop *loop, uint32_t worker, const csg_shell *shell);

/* Without leaves; CSGM_OK or CSGM_ERR_MEMORY (reported). To be ended in both cases. */
csgm_status csg_cell_loop_begin(csg_cell_loop *loop, csg_extraction *x);
void csg_cell_loop_end(csg_cell_loop *loop);
/* False: out of memory. */
bool csg_cell_loop_list(csg_cell_loop *loop, uint32_t brick);
/* Marks of bricks, a byte each: */
enum { CSG_MARK_AROUND = 2 };
/* Marks the bricks that the leaves of one share edges and faces with: those around it, and those in
 * the place of cells of all of these. */
void csg_cell_loop_mark_around(const csg_bricks *bricks, uint32_t number, uint8_t *marks);
/* Lists the bricks that have leaves and this mark, and no others. CSGM_OK or CSGM_ERR_MEMORY
 * (reported). */
csgm_status csg_cell_loop_list_marked(csg_cell_loop *loop, const uint8_t *marks, uint8_t mark);
/* Without the bricks that are listed. */
void csg_cell_loop_clear(csg_cell_loop *loop);
/* Has the shells of the bricks that are listed made once for all loops over them, if there is
 * memory for that. */
void csg_cell_loop_keep_shells(csg_cell_loop *loop);
/* Visits the bricks listed. CSGM_OK or why it was stopped (reported). */
csgm_status csg_cell_loop_run(csg_cell_loop *loop, csg_visit_brick *visit, double before,
                              double amount);
/* Enters the vertices that were made, to be found by their places. CSGM_OK or CSGM_ERR_MEMORY
 * (reported). */
csgm_status csg_cell_loop_enter(csg_cell_loop *loop);

/* Any worker. False: out of memory, reported. */
bool csg_cells_add_vertex(csg_cell_loop *loop, uint32_t worker, const csg_placed_vertex *vertex);
bool csg_cells_add_triangle(csg_cell_loop *loop, uint32_t worker, uint32_t a, uint32_t b,
                            uint32_t c);

/* The middle of an edge or face of a cell, in half cells of the finest level: it is no other's.
 * local: in quarters of the cell, as csg_local_place has it. */
uint64_t csg_cells_place(const csg_bricks *bricks, const csg_brick *brick, const unsigned cell[3],
                         unsigned local);
/* Where no vertex is. */
#define CSG_CELLS_NO_PLACE UINT64_MAX

/* The place of a part of a side, as csg_face_side has them: of CSG_BETWEEN that of side->crease,
 * the others' a quarter of the face from there, along the axis after the face's own. */
uint64_t csg_cells_place_of_part(const csg_bricks *bricks, const csg_brick *brick,
                                 const unsigned cell[3], const csg_polygon_side *side,
                                 unsigned part);
/* The vertex there; CSG_TABLE_NONE. */
uint32_t csg_cells_find_vertex(const csg_cell_loop *loop, uint64_t place);

#endif
