/* SPDX-License-Identifier: MIT
 * Units of length by their size and by the word that options and files have for them.
 */
#ifndef CSG_IO_UNITS_H
#define CSG_IO_UNITS_H

#include <string.h>

#include "csgmesh/csgmesh.h"

/* NONE counts as a metre: glTF's numbers are then the scene's. */
static inline double csg_unit_metres(csgm_unit unit)
{
    switch (unit) {
    case CSGM_UNIT_MM:
        return 0.001;
    case CSGM_UNIT_CM:
        return 0.01;
    case CSGM_UNIT_IN:
        return 0.0254;
    case CSGM_UNIT_NONE:
    case CSGM_UNIT_M:
        break;
    }
    return 1;
}

static inline const char *csg_unit_word(csgm_unit unit)
{
    static const char *const words[] = {"none", "mm", "cm", "m", "in"};
    return words[unit];
}

/* False: no unit has this word. */
static inline bool csg_unit_from_word(const char *word, csgm_unit *unit)
{
    for (int i = CSGM_UNIT_NONE; i <= CSGM_UNIT_IN; i++)
        if (strcmp(word, csg_unit_word((csgm_unit)i)) == 0) {
            *unit = (csgm_unit)i;
            return true;
        }
    return false;
}

/* As 3MF and AMF call them. */
static inline const char *csg_unit_name(csgm_unit unit)
{
    static const char *const names[] = {"millimeter", "millimeter", "centimeter", "meter", "inch"};
    return names[unit];
}

/* In millimetres, by such a name; 1 where it is none. */
static inline double csg_unit_mm(const char *name)
{
    static const struct {
        const char *name;
        double mm;
    } others[] = {{"micron", 0.001}, {"foot", 304.8}, {"feet", 304.8}};
    for (int i = CSGM_UNIT_MM; name && i <= CSGM_UNIT_IN; i++)
        if (strcmp(name, csg_unit_name((csgm_unit)i)) == 0)
            return csg_unit_metres((csgm_unit)i) * 1000;
    for (int i = 0; name && i < 3; i++)
        if (strcmp(name, others[i].name) == 0)
            return others[i].mm;
    return 1;
}

/* The unit of that many millimetres, as csg_unit_mm gives them. */
static inline csgm_unit csg_unit_of_mm(double mm)
{
    for (int i = CSGM_UNIT_CM; i <= CSGM_UNIT_IN; i++)
        if (csg_unit_metres((csgm_unit)i) * 1000 == mm)
            return (csgm_unit)i;
    return CSGM_UNIT_MM;
}

#endif
