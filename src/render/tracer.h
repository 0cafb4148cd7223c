/* SPDX-License-Identifier: MIT
 * Sphere tracing of a batch of rays through the octree of cells.h, cell by cell: all rays of the
 * batch that enter a cell march through it together, so that the kernels run its short tape over
 * hundreds of points at once. What a ray finds depends on itself and the cells alone, not on the
 * batch. Positions are floats relative to the field's centre.
 */
#ifndef CSG_RENDER_TRACER_H
#define CSG_RENDER_TRACER_H

#include "render/camera.h"
#include "render/cells.h"

enum {
    CSG_RAYS_MOST = 1296, /* a multiple of CSG_LANES; 36^2 */
    CSG_RAYS_ROWS = 40    /* rows of pixels that a batch may span */
};

/* Rays and what they found. t: along the unit direction; INFINITY = nothing. The rest is set where
 * something was hit. */
typedef struct csg_rays {
    uint32_t count;
    /* Rays stand in the order of rows of pixels: those of row first_row + i are row[i] .. row[i +
     * 1], so that a small cell need not look at all of them. Set by csg_tracer_aim. */
    uint32_t first_row, row_count;
    uint16_t row[CSG_RAYS_ROWS + 1];
    float px[CSG_RAYS_MOST], py[CSG_RAYS_MOST]; /* pixel coordinates */
    float ox[CSG_RAYS_MOST], oy[CSG_RAYS_MOST], oz[CSG_RAYS_MOST];
    float dx[CSG_RAYS_MOST], dy[CSG_RAYS_MOST], dz[CSG_RAYS_MOST];
    float ix[CSG_RAYS_MOST], iy[CSG_RAYS_MOST], iz[CSG_RAYS_MOST]; /* 1 / d */
    float from[CSG_RAYS_MOST];      /* t at which a ray begins; INFINITY: it is none */
    bool is_within[CSG_RAYS_MOST];  /* it begins in the solid, and looks for the next surface */
    float known_lit[CSG_RAYS_MOST]; /* `lit` of what faces the light, if not below 0 */
    float t[CSG_RAYS_MOST];
    float nx[CSG_RAYS_MOST], ny[CSG_RAYS_MOST], nz[CSG_RAYS_MOST]; /* unit, outward */
    float r[CSG_RAYS_MOST], g[CSG_RAYS_MOST], b[CSG_RAYS_MOST];    /* sRGB 0..1, of the scene */
    float alpha[CSG_RAYS_MOST];                                    /* 1: nothing behind is seen */
    float metallic[CSG_RAYS_MOST], roughness[CSG_RAYS_MOST];
    float inverse_slope[CSG_RAYS_MOST]; /* 1 / the field's slope */
    float open[CSG_RAYS_MOST];          /* 1 - ambient occlusion */
    float lit[CSG_RAYS_MOST];           /* share of the key light that arrives */
    float ground[CSG_RAYS_MOST];        /* how dark the ground is there; set by csg_ground_trace */
} csg_rays;

/* Those of a batch that are in one cell, packed. */
typedef struct csg_march {
    uint32_t count;
    uint16_t ray[CSG_RAYS_MOST];
    float x[CSG_RAYS_MOST], y[CSG_RAYS_MOST], z[CSG_RAYS_MOST], f[CSG_RAYS_MOST];
    float t[CSG_RAYS_MOST], begin[CSG_RAYS_MOST], end[CSG_RAYS_MOST];
    float radius[CSG_RAYS_MOST], step[CSG_RAYS_MOST]; /* of the last step */
    float channel[4][CSG_RAYS_MOST];
    uint32_t hit_count;
    uint16_t hit[CSG_RAYS_MOST];
} csg_march;

typedef struct csg_trace_counts {
    uint64_t rays, shadow_rays, hits;
    uint64_t point_evaluations, gradient_evaluations, primitive_evaluations;
} csg_trace_counts;

/* One thread's room. */
typedef struct csg_trace_room {
    csg_rays rays;
    csg_march march;
    float *scratch;
    size_t scratch_floats;
    csg_trace_counts counts;
} csg_trace_room;

typedef struct csg_pixel_rectangle {
    float min_x, min_y, max_x, max_y;
} csg_pixel_rectangle;

typedef struct csg_tracer {
    const csg_kernel *kernel;
    const csgm_field *field;
    const csg_ray_cells *cells;
    csg_view view;                         /* relative to the field's centre */
    const csg_pixel_rectangle *rectangles; /* where each cell is in the picture */
    float light[3];                        /* unit, towards the key light */
    float light_across[2][3];              /* at right angles to it and each other */
    float near_tolerance, tolerance_slope; /* |f| / lambda of a hit: near + slope * t */
    float inverse_lipschitz;
    float depth;    /* -f far from the solid: no place outside has more; INFINITY: no bound */
    float steepest; /* the field's slope near its surface, where that is largest, as measured */
    bool is_loose;  /* lambda is far above that slope */
    bool occlusion, shadows, colors;
    bool is_clear; /* some colours are seen through */
} csg_tracer;

/* Where each of the tracer's cells is in the picture; cells->count of them. */
void csg_tracer_find_rectangles(const csg_tracer *tracer, csg_pixel_rectangle *out);

/* Forgets all rays; those that are aimed next lie in rows of pixels from first_row on. */
void csg_tracer_begin(csg_rays *rays, uint32_t first_row);
/* Sets the ray's origin and direction, through a place of the view; its light is not known. */
void csg_tracer_direct(const csg_tracer *tracer, csg_rays *rays, uint32_t ray, double x, double y);
/* Appends a ray of the view; y may not fall below an earlier one's row of pixels. */
void csg_tracer_aim(const csg_tracer *tracer, csg_rays *rays, double x, double y);

/* slope.c: fills depth, steepest and is_loose by looking around and into the cells. */
void csg_tracer_find_slope(csg_tracer *tracer, csg_trace_room *room);

/* room->rays, aimed (what they begin with may be set anew): fills the rest. */
void csg_tracer_trace(const csg_tracer *tracer, csg_trace_room *room);

/* By how much what a ray has hit may seem to lie behind a surface and still be the same: rays stop
 * some tolerances before it, and the more the flatter they meet it. */
float csg_tracer_slack(const csg_tracer *tracer, const csg_rays *rays, uint32_t ray);

/* shadow.c: fills `lit` of what was hit. */
void csg_tracer_shade_light(const csg_tracer *tracer, csg_trace_room *room);
/* Fills `open` of the march's points, which are at its rays, by a tape that knows what is around
 * them; march.radius: the field's slope there. */
void csg_tracer_shade_sky(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room);

/* [*begin, *end] of the ray in the cube; false: it misses. */
static inline bool csg_ray_in_cube(const float o[3], const float inverse[3], const float center[3],
                                   float half, float *begin, float *end)
{
    float first = 0, last = INFINITY;
    half *= 1 + CSG_RAY_CELL_OVERLAP;
    for (int axis = 0; axis < 3; axis++) {
        float middle = (center[axis] - o[axis]) * inverse[axis];
        float reach = half * (inverse[axis] < 0 ? -inverse[axis] : inverse[axis]);
        first = first > middle - reach ? first : middle - reach;
        last = last < middle + reach ? last : middle + reach;
    }
    *begin = first;
    *end = last;
    return first <= last;
}

#endif
