/* SPDX-License-Identifier: MIT
 * Records with their length and a check over their bytes (FNV-1a, Fowler, Noll and Vo 1991); see
 * journal.h. A record is written behind its place and counts once its last byte is there.
 */
#include "base/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

typedef struct record_head {
    uint32_t mark, kind;
    uint64_t bytes, check; /* of what follows, and over kind, bytes and that */
} record_head;

enum { HEAD_KIND = 0 };
static const uint32_t MARK = 0x4a475343; /* "CSGJ" */
static const uint64_t FNV_BEGIN = 14695981039346656037u, FNV_PRIME = 1099511628211u;

static uint64_t check_over(uint64_t check, const void *bytes, uint64_t count)
{
    const uint8_t *at = bytes;
    for (uint64_t i = 0; i < count; i++)
        check = (check ^ at[i]) * FNV_PRIME;
    return check;
}

static uint64_t check_of_head(const record_head *head)
{
    uint64_t check = check_over(FNV_BEGIN, &head->kind, sizeof head->kind);
    return check_over(check, &head->bytes, sizeof head->bytes);
}

static bool read_at(int fd, void *bytes, uint64_t count, uint64_t at)
{
    uint8_t *to = bytes;
    while (count) {
        ssize_t got = pread(fd, to, count, (off_t)at);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        to += got;
        at += (uint64_t)got;
        count -= (uint64_t)got;
    }
    return true;
}

static int write_at(int fd, const void *bytes, uint64_t count, uint64_t at)
{
    const uint8_t *from = bytes;
    while (count) {
        ssize_t written = pwrite(fd, from, count, (off_t)at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return written < 0 ? errno : EIO;
        from += written;
        at += (uint64_t)written;
        count -= (uint64_t)written;
    }
    return 0;
}

static uint64_t size_of(int fd)
{
    off_t size = lseek(fd, 0, SEEK_END);
    return size < 0 ? 0 : (uint64_t)size;
}

void *csg_journal_read(csg_journal *journal, uint32_t kind, uint64_t *bytes)
{
    record_head head;
    uint64_t size = size_of(journal->fd), body = journal->at + sizeof head;
    if (body > size || !read_at(journal->fd, &head, sizeof head, journal->at) ||
        head.mark != MARK || head.kind != kind || !head.bytes || head.bytes > size - body)
        return NULL;
    void *record = csg_memory_alloc(journal->memory, (size_t)head.bytes);
    if (!record)
        return NULL;
    if (!read_at(journal->fd, record, head.bytes, body) ||
        check_over(check_of_head(&head), record, head.bytes) != head.check) {
        csg_memory_release(journal->memory, record, (size_t)head.bytes);
        return NULL;
    }
    *bytes = head.bytes;
    journal->at = body + head.bytes;
    return record;
}

int csg_journal_write(csg_journal *journal, uint32_t kind, const csg_journal_piece *pieces,
                      int count, bool sync)
{
    record_head head = {.mark = MARK, .kind = kind};
    for (int i = 0; i < count; i++)
        head.bytes += pieces[i].count;
    head.check = check_of_head(&head);
    int error = ftruncate(journal->fd, (off_t)journal->at) == 0 ? 0 : errno;
    uint64_t at = journal->at + sizeof head;
    for (int i = 0; i < count && !error; i++) {
        head.check = check_over(head.check, pieces[i].bytes, pieces[i].count);
        error = write_at(journal->fd, pieces[i].bytes, pieces[i].count, at);
        at += pieces[i].count;
    }
    if (!error)
        error = write_at(journal->fd, &head, sizeof head, journal->at);
    if (!error && sync && fdatasync(journal->fd) != 0)
        error = errno;
    if (!error)
        journal->at = at;
    return error;
}

int csg_journal_open(csg_journal *journal, csg_memory *memory, const char *path, const void *head,
                     uint64_t head_bytes)
{
    *journal =
        (csg_journal){.memory = memory, .fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666)};
    if (journal->fd < 0)
        return errno;
    uint64_t bytes = 0;
    void *had = csg_journal_read(journal, HEAD_KIND, &bytes);
    bool fits = had && bytes == head_bytes && memcmp(had, head, (size_t)bytes) == 0;
    csg_memory_release(memory, had, (size_t)bytes);
    if (fits)
        return 0;
    journal->at = 0;
    const csg_journal_piece piece = {head, head_bytes};
    int error = csg_journal_write(journal, HEAD_KIND, &piece, 1, false);
    if (error)
        csg_journal_close(journal);
    return error;
}

void csg_journal_close(csg_journal *journal)
{
    if (journal->memory && journal->fd >= 0)
        close(journal->fd);
    *journal = (csg_journal){.fd = -1};
}
