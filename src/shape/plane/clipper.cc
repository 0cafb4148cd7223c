/* SPDX-License-Identifier: MIT
 * Set operations and offsets by the Clipper library, version 6 (A. Johnson; the sweep of Vatti 1992
 * in whole numbers). What it throws becomes a status here.
 */
#include "shape/plane/clipper.h"

#include <new>

#include <clipper.hpp>

namespace
{

ClipperLib::Paths paths_of(const csg_clipper_loops *loops)
{
    ClipperLib::Paths paths;
    paths.reserve(loops->loop_count);
    size_t i = 0;
    for (size_t loop = 0; loop < loops->loop_count; loop++) {
        ClipperLib::Path path;
        path.reserve(loops->ends[loop] - i);
        for (; i < loops->ends[loop]; i++)
            path.emplace_back(loops->points[i].x, loops->points[i].y);
        paths.push_back(std::move(path));
    }
    return paths;
}

csgm_status hand_over(const ClipperLib::Paths &paths, csg_clipper_take *take, void *user)
{
    std::vector<csg_clipper_point> points;
    for (const ClipperLib::Path &path : paths) {
        points.clear();
        for (const ClipperLib::IntPoint &point : path)
            points.push_back({point.X, point.Y});
        if (!take(user, points.data(), points.size()))
            return CSGM_ERR_MEMORY;
    }
    return CSGM_OK;
}

template <class Work> csgm_status guarded(Work work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return CSGM_ERR_MEMORY;
    } catch (...) {
        return CSGM_ERR_INTERNAL; /* coordinates are in range, so this has no cause we know */
    }
}

ClipperLib::ClipType type_of(csg_polygons_op op)
{
    return op == CSG_POLYGONS_UNION          ? ClipperLib::ctUnion
           : op == CSG_POLYGONS_INTERSECTION ? ClipperLib::ctIntersection
                                             : ClipperLib::ctDifference;
}

ClipperLib::JoinType join_of(csg_corner corner)
{
    return corner == CSG_CORNER_ROUND   ? ClipperLib::jtRound
           : corner == CSG_CORNER_MITER ? ClipperLib::jtMiter
                                        : ClipperLib::jtSquare;
}

/* Spikes are cut at this many times the distance: in effect, not (as in OpenSCAD). */
const double miter_limit = 1e6;

} // namespace

bool csg_clipper_available(void)
{
    return true;
}

csgm_status csg_clipper_combine(csg_polygons_op op, csg_fill fill, const csg_clipper_loops *a,
                                const csg_clipper_loops *b, csg_clipper_take *take, void *user)
{
    return guarded([&] {
        ClipperLib::Clipper clipper;
        ClipperLib::Paths result;
        ClipperLib::PolyFillType rule =
            fill == CSG_FILL_EVEN_ODD ? ClipperLib::pftEvenOdd : ClipperLib::pftNonZero;
        bool has_a = clipper.AddPaths(paths_of(a), ClipperLib::ptSubject, true);
        bool has_b = clipper.AddPaths(paths_of(b), ClipperLib::ptClip, true);
        if (!has_a && !has_b) /* nothing with area; Execute would call that a failure */
            return CSGM_OK;
        if (!clipper.Execute(type_of(op), result, rule, rule))
            return CSGM_ERR_INTERNAL;
        return hand_over(result, take, user);
    });
}

csgm_status csg_clipper_offset(const csg_clipper_loops *in, double by, csg_corner corner,
                               double arc_tolerance, csg_clipper_take *take, void *user)
{
    return guarded([&] {
        ClipperLib::ClipperOffset offset(miter_limit, arc_tolerance);
        ClipperLib::Paths result;
        offset.AddPaths(paths_of(in), join_of(corner), ClipperLib::etClosedPolygon);
        offset.Execute(result, by);
        return hand_over(result, take, user);
    });
}
