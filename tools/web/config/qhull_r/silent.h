/* SPDX-License-Identifier: MIT
 * Before every file of Qhull: it gathers no statistics, and what it would print, which nobody
 * reads, is not made. Its answers are the same.
 */
#ifndef CSGMESH_QHULL_SILENT_H
#define CSGMESH_QHULL_SILENT_H

#include <libqhull_r/user_r.h>
#undef qh_KEEPstatistics
#define qh_KEEPstatistics 0
#include <libqhull_r/qhull_ra.h>

/* As userprintf_r.c, which is left out, does for the codes of errors. */
static inline void csgmesh_qhull_told(qhT *qh, int code)
{
    if (qh && code >= MSG_ERROR && code < MSG_WARNING)
        qh->last_errcode = code;
}

#define qh_fprintf(qh, file, code, ...) csgmesh_qhull_told(qh, code)

#endif
