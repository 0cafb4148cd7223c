/* SPDX-License-Identifier: MIT
 * The window over a file in runs; see runs.h.
 */
#include "io/runs.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "io/reader.h"

static csgm_status read_up_to(csg_runs *r, void *bytes, size_t count, uint64_t byte, size_t *got)
{
    *got = 0;
    while (*got < count) {
        ssize_t some = pread(r->fd, (uint8_t *)bytes + *got, count - *got, (off_t)(byte + *got));
        if (some == 0)
            break;
        if (some < 0 && errno != EINTR)
            return csg_read_failed(r->context, r->path, errno);
        *got += some > 0 ? (size_t)some : 0;
    }
    return CSGM_OK;
}

void csg_runs_seek(csg_runs *r, uint64_t byte)
{
    r->at = r->end = 0;
    r->window_ends = byte;
}

const uint8_t *csg_runs_take(csg_runs *r, size_t count, csgm_status *status)
{
    *status = CSGM_OK;
    if (r->end - r->at < count) {
        size_t got, left = r->end - r->at;
        memmove(r->window, r->window + r->at, left);
        *status =
            read_up_to(r, r->window + left, CSG_RUNS_WINDOW_BYTES - left, r->window_ends, &got);
        r->at = 0;
        r->end = left + got;
        r->window_ends += got;
        if (*status || r->end < count)
            return NULL;
    }
    r->at += count;
    return r->window + r->at - count;
}

csgm_status csg_runs_read_at(csg_runs *r, void *bytes, size_t count, uint64_t byte)
{
    size_t got;
    csgm_status status = read_up_to(r, bytes, count, byte, &got);
    if (!status && got < count)
        return csg_read_broken(&(csg_input){.context = r->context, .path = r->path}, 0,
                               CSG_READ_SHORTER);
    return status;
}
