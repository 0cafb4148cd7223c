/* SPDX-License-Identifier: MIT
 * Intervals as text for people: ends are rounded outward, to digits that tell them apart.
 */
#ifndef CLI_INTERVAL_H
#define CLI_INTERVAL_H

#include "csgmesh/csgmesh.h"

enum { CLI_INTERVAL_TEXT = 840 };

/* "1.23 .. 1.24", or "not known" where an end is infinite. Returns text. */
const char *cli_format_interval(char text[CLI_INTERVAL_TEXT], csgm_interval interval);
/* A lower bound > 0, with so many digits, rounded down. Returns text. */
const char *cli_format_least(char text[CLI_INTERVAL_TEXT], double value, int digits);

#endif
