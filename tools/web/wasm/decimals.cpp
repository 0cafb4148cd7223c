/* SPDX-License-Identifier: MIT
 * What libc++'s std::to_chars calls for a given number of digits, in place of its own: by the
 * printf of wasi-libc, which is as exact, as both round the binary value itself. libc++'s needs
 * tables of 104 kB, which hardly compress.
 */
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "include/ryu/d2fixed.h"

/* The digits before the point of the largest number, and those behind it of the smallest. */
static constexpr uint32_t MOST_BEFORE = 310, MOST_BEHIND = 1100;

static std::to_chars_result put(char *first, char *last, const char *format, double value,
                                uint32_t digits)
{
    char text[MOST_BEFORE + MOST_BEHIND];
    if (digits >= MOST_BEHIND)
        return {last, std::errc::value_too_large};
    int length = std::snprintf(text, sizeof text, format, static_cast<int>(digits), value);
    if (length > last - first)
        return {last, std::errc::value_too_large};
    std::memcpy(first, text, static_cast<size_t>(length));
    return {first + length, std::errc()};
}

_LIBCPP_BEGIN_NAMESPACE_STD

void __append_n_digits(const uint32_t count, uint32_t digits, char *const text)
{
    for (uint32_t i = count; i > 0; digits /= 10)
        text[--i] = static_cast<char>('0' + digits % 10);
}

void __append_nine_digits(uint32_t digits, char *const text)
{
    __append_n_digits(9, digits, text);
}

to_chars_result __d2fixed_buffered_n(char *first, char *const last, const double value,
                                     const uint32_t digits)
{
    return put(first, last, "%.*f", value, digits);
}

to_chars_result __d2exp_buffered_n(char *first, char *const last, const double value,
                                   uint32_t digits)
{
    return put(first, last, "%.*e", value, digits);
}

_LIBCPP_END_NAMESPACE_STD
