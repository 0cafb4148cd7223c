/* SPDX-License-Identifier: MIT
 * std::sort for Clipper as GNU's library does it, which the command line's Clipper is built with.
 * Neither library says what becomes of elements that are neither before nor behind each other,
 * Clipper has such ones (minima at one height), and their order shows in the order of its loops. So
 * here are the same comparisons and moves: Musser's introsort with the median of three as the
 * pivot, down to stretches of sixteen, which one insertion sort ends.
 */
#ifndef CSGMESH_WEB_SORT_H
#define CSGMESH_WEB_SORT_H
#ifdef __cplusplus

#include <algorithm>
#include <iterator>
#include <utility>

namespace csgmesh
{

constexpr int short_stretch = 16;

/* The median of the second, the middle and the last one comes first. */
template <class It, class Less> void put_pivot_first(It first, It last, Less less)
{
    It a = first + 1, b = first + (last - first) / 2, c = last - 1, median = c;
    if (less(*a, *b))
        median = less(*b, *c) ? b : less(*a, *c) ? c : a;
    else
        median = less(*a, *c) ? a : less(*b, *c) ? c : b;
    std::iter_swap(first, median);
}

template <class It, class Less> It part_at_pivot(It first, It last, Less less)
{
    It pivot = first++;
    for (;; ++first) {
        while (less(*first, *pivot))
            ++first;
        do
            --last;
        while (less(*pivot, *last));
        if (!(first < last))
            return first;
        std::iter_swap(first, last);
    }
}

template <class It, class Less> void divide(It first, It last, int depth, Less less)
{
    for (; last - first > short_stretch; depth--) {
        if (depth == 0) /* as slow as it gets: a sort by a heap */
            return std::partial_sort(first, last, last, less);
        put_pivot_first(first, last, less);
        It cut = part_at_pivot(first, last, less);
        divide(cut, last, depth - 1, less);
        last = cut;
    }
}

/* Into what stands before it, where something is known to be no larger. */
template <class It, class Less> void insert(It at, Less less)
{
    auto value = std::move(*at);
    for (; less(value, *(at - 1)); --at)
        *at = std::move(*(at - 1));
    *at = std::move(value);
}

template <class It, class Less> void insert_all(It first, It last, Less less)
{
    It guarded = last - first > short_stretch ? first + short_stretch : last;
    for (It at = first + 1; at < last; ++at) {
        if (at < guarded && less(*at, *first))
            std::rotate(first, at, at + 1);
        else
            insert(at, less);
    }
}

} // namespace csgmesh

namespace std
{

/* Preferred to the library's own, which asks nothing of its iterators. */
template <class It, class Less>
requires random_access_iterator<It>
void sort(It first, It last, Less less)
{
    int depth = 0;
    for (auto n = last - first; n > 1; n >>= 1)
        depth += 2;
    if (first != last) {
        csgmesh::divide(first, last, depth, less);
        csgmesh::insert_all(first, last, less);
    }
}

} // namespace std

#endif
#endif
