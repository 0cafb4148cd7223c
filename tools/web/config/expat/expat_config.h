/* SPDX-License-Identifier: MIT
 * What expat's own build would write.
 */
#define BYTEORDER 1234
#define HAVE_MEMMOVE 1
#define XML_CONTEXT_BYTES 1024
#define XML_DTD 1
#define XML_NS 1
#define XML_POOR_ENTROPY 1 /* files are the user's own, and hashed without a secret */
