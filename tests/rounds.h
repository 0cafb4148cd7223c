/* SPDX-License-Identifier: MIT
 * How many rounds of a random search a build makes. Sanitizers look for faults of memory and
 * arithmetic, which the first rounds have as well as the last, and take three to ten times as long:
 * they get a quarter of the rounds, the optimised build all of them.
 */
#ifndef TEST_ROUNDS_H
#define TEST_ROUNDS_H

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TEST_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TEST_SANITIZED 1
#endif

#ifdef TEST_SANITIZED
#define ROUNDS(all) (((all) + 3) / 4)
#else
#define ROUNDS(all) (all)
#endif

#endif
