/* SPDX-License-Identifier: MIT
 * What FriBidi's own build would write. LIBRARY_VERSION is given by libraries.py.
 */
#define FRIBIDI "fribidi"
#define FRIBIDI_NAME "GNU FriBidi"
#define FRIBIDI_BUGREPORT ""
#define FRIBIDI_VERSION LIBRARY_VERSION
#define FRIBIDI_INTERFACE_VERSION 4
#define FRIBIDI_INTERFACE_VERSION_STRING "4"
#define FRIBIDI_SIZEOF_INT 4
