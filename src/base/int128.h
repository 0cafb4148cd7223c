/* SPDX-License-Identifier: MIT
 * Integers of 128 bits, which all our compilers have: for sums and signs that must be exact.
 */
#ifndef CSG_BASE_INT128_H
#define CSG_BASE_INT128_H

__extension__ typedef __int128 csg_int128;

#endif
