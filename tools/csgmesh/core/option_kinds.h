/* SPDX-License-Identifier: MIT
 * The types of options' values, apart from the options themselves, so that a new option concerns
 * those alone who ask for options.
 */
#ifndef CLI_OPTION_KINDS_H
#define CLI_OPTION_KINDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

typedef struct cli_list {
    const char **items; /* borrowed from argv */
    size_t count;
} cli_list;

typedef struct cli_points {
    csgm_vec3 *items;
    size_t count;
} cli_points;

typedef struct cli_bits {
    uint32_t position, normal, color;
} cli_bits;

/* One C type for each kind of option. */
typedef bool cli_kind_FLAG;
typedef const char *cli_kind_TEXT;
typedef cli_list cli_kind_LIST;
typedef uint64_t cli_kind_COUNT;     /* 1 .. 2^32 - 1 */
typedef double cli_kind_NUMBER;      /* > 0, finite */
typedef double cli_kind_NONNEGATIVE; /* >= 0, finite; P% is P / 100 */
typedef struct cli_amount {
    double value; /* > 0, finite; a share is below 1 */
    bool is_share;
} cli_amount;
typedef cli_amount cli_kind_AMOUNT; /* a length, or P% */
typedef uint64_t cli_kind_BYTES;    /* K, M, G, T are powers of 1024 */
typedef int cli_kind_CHOICE;        /* index into the values */
typedef csgm_box cli_kind_BOX;      /* finite, min < max */
typedef cli_points cli_kind_POINTS;
typedef const char *cli_kind_REPORT; /* optional "=FILE"; "-" without */
typedef cli_bits cli_kind_BITS;
typedef uint32_t cli_kind_LEVEL; /* 0 .. 10 */

#endif
