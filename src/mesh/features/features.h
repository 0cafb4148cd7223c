/* SPDX-License-Identifier: MIT
 * Sharp features: the apex of a polygon of marching cubes that a crease, a corner or a tip of the
 * surface runs through. The polygon is fanned around its apex as in extended marching cubes
 * (Kobbelt, Botsch, Schwanecke, Seidel 2001), and where a crease passes from one polygon to the
 * next, the segment between them is flipped: two apexes become joined by an edge of the mesh.
 *
 * A crease is found by what the gradient does, not by what made it: where it jumps along a segment
 * however short the rest of it. An apex is the point where the tangent planes meet of the sheets
 * around it, taken ever nearer to it, so it answers to the field itself: edges of primitives, of
 * operators, of polyhedra and of expressions alike (find, solve).
 *
 * Whether a polygon has an apex depends on its block alone; flips on two neighbours, so features
 * are kept for the whole mesh, in memory of the length of its creases (store). A polygon
 * with an apex has two triangles more than without, flips change no number: blocks can be counted
 * and filled in any order.
 */
#ifndef CSG_MESH_FEATURES_FEATURES_H
#define CSG_MESH_FEATURES_FEATURES_H

#include "mesh/features/around.h"
#include "mesh/marching/marching.h"

enum {
    CSG_FEATURE_MOST_SIDES = 12,
    CSG_FEATURE_MOST_SHEETS = 8,
    CSG_FEATURE_APEX = 0xFF,
    CSG_FEATURE_BEYOND = 0x80,
    CSG_FEATURE_SEGMENTS = 8192 /* candidates of one block at most */
};

#define CSG_FEATURE_NONE UINT32_MAX

/* What is known of a polygon's apex. README.md has the transitions; csg_feature_enter makes them.
 */
typedef enum csg_feature_state {
    CSG_FEATURE_NEW,      /* nothing yet */
    CSG_FEATURE_UNSOLVED, /* a crease crosses it, and no apex was found by the polygon alone */
    CSG_FEATURE_FOLDED,   /* it has an apex, but its own fan folds over: one beyond must help */
    CSG_FEATURE_SOLVED,   /* it has an apex, and its own fan looks out */
    CSG_FEATURE_BARE,     /* it has none: the triangles of marching cubes, two less */
    CSG_FEATURE_GIVEN_UP  /* the same, with a vertex in one of its triangles where the apex was */
} csg_feature_state;

/* 1 - cos of 12 degrees: a crease that ends and is as blunt as this there has faded. */
#define CSG_FEATURE_FADING 0.0219f

/* What a feature has for each side of its polygon: side s leads from corner s to corner s + 1. */
typedef struct csg_feature_side {
    float corner[3];     /* corner s, field frame */
    uint32_t beyond;     /* the feature beyond the side, or NONE (store.c, join.c) */
    uint8_t beyond_side; /* which of its sides this is */
    uint8_t edge;        /* the cell's crossed edge that corner s lies on */
    uint8_t sheet;       /* that corner s lies on (solve.c) */
} csg_feature_side;

/* A polygon of marching cubes that a crease, a corner or a tip runs through, or that such a one
 * next door needs. Most have four sides and two sheets, and there are as many as vertices on
 * creases: what it has for each of them stands in lists as long as these (lists.c). A copy of the
 * struct shares them. */
typedef struct csg_feature {
    /* The polygon, as find.c and bare.c have it; but for corners that make way it stays. */
    uint16_t cell;   /* (8 z + y) 8 + x */
    uint8_t pattern; /* of the cell */
    uint8_t joined;  /* its faces whose inside corners are joined: csg_cell_loops_of */
    uint8_t loop;    /* of the pattern, joined */
    uint8_t side_count;
    uint8_t sheet_count; /* what lies between creases (solve.c) */
    uint8_t state;       /* csg_feature_state */
    /* Bit s each: */
    uint16_t creased; /* a crease crosses side s, or it is bent */
    uint16_t flipped; /* side s is: both apexes are joined by an edge in its place (join.c) */
    /* Of the two triangles at a flipped side each feature has one: that at the side's end, corner
     * s + 1, otherwise that at corner s. */
    uint16_t takes_next;
    uint16_t bent;          /* both ends of side s are in one sheet, but an apex reaches across */
    csg_feature_side *side; /* counter-clockwise from outside */

    /* The apex, and how the polygon is cut (apex.c, move.c, cut.c). */
    float at[3];        /* field frame */
    uint32_t vertex;    /* its number; of the first sheet where there is one per sheet */
    float (*normal)[3]; /* of each sheet there: unit, outward */
    /* As many as sides: of corners of the polygon, CSG_FEATURE_APEX, or CSG_FEATURE_BEYOND + s: the
     * apex beyond side s. The first that is a corner of the polygon lies in the triangle's sheet.
     */
    uint8_t (*triangle)[3];
    uint8_t tries; /* to find another place */
    bool ends;     /* a crease ends here: the polygon beyond a creased side has none */

    /* Vertices that have made way (shift.c). */
    uint16_t moved; /* bit s: corner s is not where its lattice edge has it */
    bool made_way;  /* one has for this feature */
    uint8_t moves;  /* of its corners until now */
    uint8_t shift;  /* how much has been tried of that */

    bool is_plane; /* beside its creases the surface was, where they cross its sides */
} csg_feature;

/* A feature with lists of its own, long enough for any: where one is made, or kept as it was. */
typedef struct csg_feature_whole {
    csg_feature feature;
    struct {
        csg_feature_side side[CSG_FEATURE_MOST_SIDES];
        float normal[CSG_FEATURE_MOST_SHEETS][3];
        uint8_t triangle[CSG_FEATURE_MOST_SIDES][3];
    } lists;
} csg_feature_whole;

/* A vertex that has made way for a corner of the solid (shift.h). */
typedef struct csg_feature_moved {
    uint32_t feature[4]; /* that it is a corner of */
    uint32_t asker;      /* the feature that it has made way for */
    uint8_t corner[4];
    float from[3], normal[3]; /* outward, at its new place */
    bool back;                /* it has been put back */
} csg_feature_moved;

/* The features of one block, in the order of its cells. */
typedef struct csg_feature_block {
    uint32_t at[3];
    uint32_t first, count, bare; /* bare: of these, without an apex */
    uint32_t vertices;           /* apexes, or sheets of all apexes where normals are split */
    uint32_t triangles;          /* more than without features */
} csg_feature_block;

typedef struct csg_feature_store {
    csg_memory *memory;
    csg_feature *features;
    csg_arena lists;  /* theirs, */
    csg_arena *taken; /* and those that came with the features of rooms */
    csg_feature_block *blocks;
    size_t count, capacity, block_count, block_capacity, taken_count, taken_capacity;
    csg_table index; /* of the blocks; no slots before it is made */
    csg_feature_moved *moves;
    size_t move_count, move_capacity;
    size_t bare; /* of the features, those without an apex */
    double cell_size;
    size_t numbered; /* blocks whose features have vertex numbers */
    uint64_t smooth; /* polygons that a crease crosses and that stay as they were */
    uint64_t fading; /* the same, where all their creases are blunt and end */
} csg_feature_store;

/* Whether README.md's table has a transition; one that it has not is a mistake here (asserted). */
bool csg_feature_may_enter(csg_feature_state from, csg_feature_state to);
void csg_feature_enter(csg_feature *feature, csg_feature_state state);

/* Made of the triangles of marching cubes; for good. */
static inline bool csg_feature_is_plain(const csg_feature *feature)
{
    return feature->state == CSG_FEATURE_BARE || feature->state == CSG_FEATURE_GIVEN_UP;
}

/* ---- lists (lists.c) ---------------------------------------------------------------------------
 */

/* The bytes of a feature's lists, a multiple of 4; and of several's. */
size_t csg_feature_list_bytes(const csg_feature *feature);
size_t csg_feature_lists_bytes(const csg_feature *features, size_t count);
/* The lists of several features stand one behind the other in `lists`, from a multiple of 4 on. */
void csg_features_lay_out(csg_feature *features, size_t count, void *lists);
/* Begins a feature: its counts of sides and sheets are those of `begun`, its lists are zeroed. */
void csg_feature_begin(csg_feature_whole *whole, const csg_feature *begun);
/* Everything from one feature to another whose own lists are long enough; they stay its own. */
void csg_feature_copy(csg_feature *to, const csg_feature *from);
void csg_feature_keep(csg_feature_whole *to, const csg_feature *from);
/* Adds a copy, with lists from the arena. False: out of memory. */
bool csg_feature_append(csg_feature **features, size_t *count, size_t *capacity, csg_arena *lists,
                        const csg_feature *feature);

/* ---- finding ------------------------------------------------------------------------------- */

/* A segment of a polygon along which the gradient jumps. */
typedef struct csg_segment {
    uint16_t from, to; /* slots of the vertices */
    uint16_t loop;     /* of the block's loops at hand */
    uint8_t side;
    uint8_t active;
    uint8_t plane, found; /* at one end so far; the bracket is as short as it gets */
    float low, high;      /* bracket of the jump, along the segment */
    float low_value, high_value, low_gradient[3], high_gradient[3];
    float jump;  /* 1 - cos of the angle that is left */
    float at[3]; /* the crease near it */
} csg_segment;

typedef struct csg_found_loop {
    uint16_t cell;
    uint8_t pattern, joined, loop, side_count;
    uint8_t edge[CSG_FEATURE_MOST_SIDES];
    uint16_t slot[CSG_FEATURE_MOST_SIDES];
    int16_t crease[CSG_FEATURE_MOST_SIDES]; /* segment, or -1 */
    bool wide;                              /* its corners' normals lie far apart */
} csg_found_loop;

/* The cells of a block that may have features, by row of cells, 8 z + y, a bit each: possible.h. */
typedef struct csg_possible_cells {
    uint8_t any[CSG_BLOCK_EDGE * CSG_BLOCK_EDGE];
    uint8_t tips[CSG_BLOCK_EDGE * CSG_BLOCK_EDGE]; /* of these: no gradient jumps in them */
} csg_possible_cells;

/* One thread's room. */
typedef struct csg_feature_room {
    csg_edges edges;
    csg_slots slots;
    float gradient[3 * CSG_BLOCK_POINTS][3]; /* by slot */
    float value[3 * CSG_BLOCK_POINTS];       /* the same */
    csg_segment segments[CSG_FEATURE_SEGMENTS];
    uint32_t segment_count;
    csg_found_loop loops[CSG_FEATURE_SEGMENTS / 4];
    uint32_t loop_count;
    uint8_t joined[CSG_BLOCK_EDGE * CSG_BLOCK_EDGE * CSG_BLOCK_EDGE]; /* by cell: pair.h */
    bool any_joined;
    csg_possible_cells possible;
    float x[CSG_FEATURE_SEGMENTS], y[CSG_FEATURE_SEGMENTS], z[CSG_FEATURE_SEGMENTS];
    float f[CSG_FEATURE_SEGMENTS], g[3][CSG_FEATURE_SEGMENTS];
    uint32_t which[CSG_FEATURE_SEGMENTS];
    csg_feature *features; /* found since it was emptied */
    csg_arena lists;       /* theirs */
    csg_arena along;       /* of the blocks at hand */
    csg_feature_block *blocks;
    size_t count, capacity, block_count, block_capacity;
    uint64_t smooth, fading, evaluations;
    csg_feature_around around;
} csg_feature_room;

void csg_feature_room_init(csg_feature_room *room);
/* Forgets the features and gives their memory back; what it has counted goes back to 0. */
void csg_feature_room_empty(csg_feature_room *room);
void csg_feature_room_release(csg_feature_room *room);
/* Adds the block's features to the room's; its roots may be kept (csg_marching_keeps_roots) until
 * room->along is reset. False: out of memory. */
bool csg_feature_find(const csg_marching *marching, csg_block *block, csg_feature_room *room,
                      csg_memory *memory, float *scratch, size_t scratch_floats);

/* ---- the store ------------------------------------------------------------------------------- */

/* Adds blocks of a room with their features, whose lists stay the room's until the store takes
 * them. False: out of memory. */
bool csg_feature_store_add(csg_feature_store *store, const csg_feature_room *room, size_t first,
                           size_t count);
/* The lists of all features of a room are the store's from now on, and the room is empty. False:
 * out of memory, lists are gone. */
bool csg_feature_store_take_lists(csg_feature_store *store, csg_feature_room *room);
/* The lists of the features from `first` on, one behind the other, *bytes of them: of csg_memory,
 * the caller's. NULL: out of memory, or there are none. */
void *csg_feature_store_pack(const csg_feature_store *store, size_t first, size_t *bytes);
/* Adds features that were packed so, with their blocks, as they stood behind the same others;
 * numbered. False: out of memory. */
bool csg_feature_store_adopt(csg_feature_store *store, const csg_feature *features, size_t count,
                             const void *lists, size_t list_bytes, const csg_feature_block *blocks,
                             size_t block_count);
/* Once all blocks are there. */
bool csg_feature_store_index(csg_feature_store *store);
/* Who lies beyond each side; where a crease crosses it, it is to be flipped. Any thread; writes one
 * block alone. */
void csg_feature_link(csg_feature_store *store, const csg_cell_tables *tables, size_t block);
/* The triangles, once all are linked, in their places and settled. As csg_feature_link. */
void csg_feature_flip(csg_feature_store *store, const csg_cell_tables *tables, size_t block);
const csg_feature_block *csg_feature_store_find(const csg_feature_store *store,
                                                const uint32_t at[3]);
void csg_feature_store_release(csg_feature_store *store);

/* ---- their vertices and triangles --------------------------------------------------------------
 */

/* One corner of a triangle: a crossed edge of the cell (edge), or an apex. */
typedef struct csg_fan_corner {
    const csg_feature *apex; /* NULL: an edge */
    const float *at;         /* of an edge's vertex that has moved; else NULL */
    uint8_t edge, sheet;
} csg_fan_corner;

/* As many as its polygon has sides; without an apex two less. */
static inline int csg_feature_triangle_count(const csg_feature *feature)
{
    return feature->side_count - (feature->state == CSG_FEATURE_BARE ? 2 : 0);
}

/* Triangle `index` of a feature. */
void csg_feature_triangle(const csg_feature_store *store, const csg_feature *feature, int index,
                          csg_fan_corner corners[3]);

#endif
