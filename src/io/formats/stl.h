/* SPDX-License-Identifier: MIT
 * How a binary STL is laid out: a head with the count of facets in its last four bytes, then
 * facets: a normal, three corners, two bytes for nothing.
 */
#ifndef CSG_IO_STL_H
#define CSG_IO_STL_H

enum { CSG_STL_HEAD_BYTES = 84, CSG_STL_FACET_BYTES = 50, CSG_STL_NORMAL_BYTES = 12 };

#endif
