/* SPDX-License-Identifier: MIT
 * OpenSCAD's camera: a gimbal (translation, rotation about x, then y, then z, distance; no rotation
 * looks from above with y upwards), or two points. Its angle of view is 22.5 degrees.
 */
#include <math.h>

#include "openscad/openscad_parts.h"

static const double DEGREE = 0.017453292519943295;

static csgm_vec3 add(csgm_vec3 a, csgm_vec3 b, double factor)
{
    return (csgm_vec3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

static double length_of(csgm_vec3 a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

static csgm_vec3 turn(csgm_vec3 p, const double *degrees)
{
    double c = cos(degrees[0] * DEGREE), s = sin(degrees[0] * DEGREE);
    p = (csgm_vec3){p.x, c * p.y - s * p.z, s * p.y + c * p.z};
    c = cos(degrees[1] * DEGREE), s = sin(degrees[1] * DEGREE);
    p = (csgm_vec3){c * p.x + s * p.z, p.y, c * p.z - s * p.x};
    c = cos(degrees[2] * DEGREE), s = sin(degrees[2] * DEGREE);
    return (csgm_vec3){c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

openscad_view openscad_view_of(const openscad_line *line, csgm_box box)
{
    const double *v = line->camera;
    csgm_vec3 first = {v[0], v[1], v[2]}, target, out; /* out: from the target to the eye */
    openscad_view view = {.up = {0, 0, 1}};
    double distance;
    if (line->camera_numbers == 7) {
        target = first;
        out = turn((csgm_vec3){0, 0, 1}, v + 3);
        view.up = turn((csgm_vec3){0, 1, 0}, v + 3);
        distance = v[6];
    } else {
        target = (csgm_vec3){v[3], v[4], v[5]};
        out = add(first, target, -1);
        distance = length_of(out);
        out = distance > 0 ? add((csgm_vec3){0, 0, 0}, out, 1 / distance) : (csgm_vec3){0, 0, 1};
        if (hypot(out.x, out.y) < 1e-9)
            view.up = (csgm_vec3){0, 1, 0};
    }
    csgm_vec3 middle = add(box.min, add(box.max, box.min, -1), 0.5);
    if (line->auto_center && line->view_all)
        target = middle;
    if (line->view_all)
        distance = (length_of(add(middle, target, -1)) + length_of(add(box.max, box.min, -1)) / 2) /
                   sin(OPENSCAD_FOV / 2 * DEGREE);
    view.target = target;
    view.eye = add(target, out, distance);
    view.height = 2 * distance * tan(OPENSCAD_FOV / 2 * DEGREE);
    return view;
}
