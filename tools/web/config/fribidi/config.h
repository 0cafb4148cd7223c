/* SPDX-License-Identifier: MIT
 * What FriBidi's own build would write.
 */
#define STDC_HEADERS 1
#define HAVE_STDLIB_H 1
#define HAVE_STRING_H 1
#define HAVE_STRINGIZE 1
