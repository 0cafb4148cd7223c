/* SPDX-License-Identifier: MIT
 * Triangles drawn by a z-buffer. draw.c projects the vertices and sorts the triangles into tiles of
 * the picture; raster.c draws a tile: first which triangle each of n x n samples per pixel sees,
 * then light, once for each triangle of a pixel. Vertices are snapped to 1/256 of a sample and
 * edges tested in integers, so triangles that share an edge leave no gap and cover nothing twice.
 */
#ifndef CSG_RENDER_DRAW_H
#define CSG_RENDER_DRAW_H

#include "render/job.h"

enum {
    CSG_DRAW_TILE = 64,        /* pixels */
    CSG_DRAW_SUBSTEPS = 256,   /* of a sample */
    CSG_DRAW_LARGEST = 1 << 29 /* snapped coordinates are held within this */
};

/* A projected vertex: snapped, from the upper left corner; nearness falls with the distance and is
 * linear across the picture. */
typedef struct csg_draw_vertex {
    int32_t x, y;
    float nearness;
    bool is_visible; /* finite, and not behind the nearest plane */
} csg_draw_vertex;

typedef struct csg_draw {
    csg_picture *picture;
    const csg_view *view; /* the picture's */
    const csgm_mesh_view *mesh;
    const struct csg_ground_map *ground; /* of ground_map.h */
    const struct csg_mesh_light *light;  /* of mesh_light.h */
    double nearest;                      /* what is nearer to the eye's plane is clipped away */
    uint32_t samples;                    /* n */
    uint32_t border;                     /* samples around a tile that are filled, too */
    bool is_clear;                       /* some of the mesh's colours are seen through */
    csg_draw_vertex *vertices;
    uint32_t columns, rows; /* of tiles */
    uint64_t *tile_first;   /* columns * rows + 1: into tile_triangles */
    uint32_t *tile_triangles;
    struct csg_draw_room **rooms; /* one per worker */
    uint32_t room_count;
} csg_draw;

/* In the scene's frame. */
csg_vec3 csg_draw_position(const csg_draw *draw, uint32_t vertex);
csg_draw_vertex csg_draw_project(const csg_draw *draw, csg_vec3 position);

/* At most two triangles: of one that the nearest plane cuts, what lies behind it. Returns how many;
 * 0: nothing of it can be seen. */
int csg_draw_corners(const csg_draw *draw, uint64_t triangle, csg_draw_vertex out[2][3]);

/* What a pixel's samples add up to. */
typedef struct csg_draw_sum {
    float light[3];
    float cover; /* samples, by how much of the background they hide */
    float line;  /* as in outline.h */
} csg_draw_sum;

/* raster.c; samples: (CSG_DRAW_TILE * n)^2 of each. */
typedef struct csg_draw_room {
    float *nearness;
    uint32_t *triangle; /* index + 1, 0 = none */
    /* Of meshes that are seen through, else NULL: how much of what is behind is seen, and what only
     * is looked at, since it is farther than what was drawn. */
    float *through, *behind;
    csg_draw_sum sums[CSG_DRAW_TILE * CSG_DRAW_TILE];
} csg_draw_room;

void csg_draw_tile(const csg_draw *draw, csg_draw_room *room, uint32_t column, uint32_t row);

/* draw.c: projects, sorts, makes the rooms, and runs `item` with the draw for each tile. */
csgm_status csg_draw_run(csg_draw *draw, csg_pool_work *item, csgm_render_stats *stats);

#endif
