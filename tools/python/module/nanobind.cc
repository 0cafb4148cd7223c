/* SPDX-License-Identifier: MIT
 * nanobind's own source, which its package brings along as one file.
 */
#include <nb_combined.cpp>
