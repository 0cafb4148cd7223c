/* SPDX-License-Identifier: MIT
 * Frames: a header with Content-Length, an empty line, the message. What is no frame is told once
 * and passed over; the next header is looked for. Messages go out whole.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "lsp/lsp.h"

enum { LARGEST_MESSAGE = 64 << 20, LARGEST_HEADER = 8192 };

bool lsp_input_fill(lsp_input *input)
{
    enum { PIECE = 65536 };
    if (input->capacity - input->length < PIECE) {
        size_t room = input->capacity ? 2 * input->capacity : (size_t)4 * PIECE;
        char *more = realloc(input->bytes, room);
        if (!more)
            return false;
        input->bytes = more;
        input->capacity = room;
    }
    ssize_t got;
    do
        got = read(STDIN_FILENO, input->bytes + input->length, PIECE);
    while (got < 0 && errno == EINTR);
    if (got <= 0)
        return false;
    size_t skipped = input->skip < (size_t)got ? input->skip : (size_t)got;
    memmove(input->bytes + input->length, input->bytes + input->length + skipped,
            (size_t)got - skipped);
    input->skip -= skipped;
    input->length += (size_t)got - skipped;
    return true;
}

static void drop(lsp_input *input, size_t count)
{
    input->length -= count;
    memmove(input->bytes, input->bytes + count, input->length);
}

/* The value of Content-Length in a header; -1: there is none that is one. */
static long long read_length(const char *header, size_t length)
{
    static const char name[] = "Content-Length:";
    const size_t size = sizeof name - 1;
    for (size_t i = 0; i + size < length; i++) {
        bool begins = i == 0 || header[i - 1] == '\n';
        if (!begins || strncasecmp(header + i, name, size) != 0)
            continue;
        size_t at = i + size;
        long long value = 0;
        while (at < length && header[at] == ' ')
            at++;
        if (at == length || header[at] < '0' || header[at] > '9')
            return -1;
        for (; at < length && header[at] >= '0' && header[at] <= '9'; at++)
            value = value < 1000000000000LL ? value * 10 + (header[at] - '0') : value;
        return at == length || header[at] == '\r' || header[at] == '\n' ? value : -1;
    }
    return -1;
}

static lsp_frame take_body(lsp_input *input, size_t header, size_t size, char **message,
                           size_t *length, const char **wrong)
{
    if (size > LARGEST_MESSAGE) {
        size_t here = input->length - header < size ? input->length - header : size;
        drop(input, header + here);
        input->skip = size - here;
        *wrong = "a message of more than 64 MiB, which is passed over";
        return LSP_FRAME_BROKEN;
    }
    if (input->length - header < size)
        return LSP_FRAME_MORE;
    *message = malloc(size + 1);
    *length = size;
    if (*message) {
        memcpy(*message, input->bytes + header, size);
        (*message)[size] = '\0';
    }
    drop(input, header + size);
    *wrong = "out of memory";
    return *message ? LSP_FRAME_MESSAGE : LSP_FRAME_BROKEN;
}

lsp_frame lsp_input_next(lsp_input *input, char **message, size_t *length, const char **wrong)
{
    const char *end = input->length ? memmem(input->bytes, input->length, "\r\n\r\n", 4) : NULL;
    if (!end && input->length >= LARGEST_HEADER) { /* all but what may be half an end */
        drop(input, input->length - 3);
        input->is_lost = true;
    }
    if (!end)
        return LSP_FRAME_MORE;
    size_t header = (size_t)(end - input->bytes) + 4;
    long long size = read_length(input->bytes, header);
    if (size >= 0 && !input->is_lost)
        return take_body(input, header, (size_t)size, message, length, wrong);
    drop(input, header);
    input->is_lost = false;
    *wrong = "a header without Content-Length: NUMBER, or with more than 8192 bytes";
    return LSP_FRAME_BROKEN;
}

bool lsp_message_open(cli_text *text, cli_json *json)
{
    if (!cli_text_open(text))
        return false;
    *json = cli_json_make(text->out, false);
    cli_json_begin(json, '{');
    cli_json_string(json, "jsonrpc", "2.0");
    return true;
}

void lsp_message_send(cli_text *text, cli_json *json)
{
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    cli_json_end(json, '}');
    char *bytes = cli_text_close(text), header[64];
    if (!bytes)
        return;
    int size = snprintf(header, sizeof header, "Content-Length: %zu\r\n\r\n", text->length);
    pthread_mutex_lock(&mutex);
    if (cli_write_fully(STDOUT_FILENO, header, (size_t)size))
        cli_write_fully(STDOUT_FILENO, bytes, text->length);
    pthread_mutex_unlock(&mutex);
    free(bytes);
}
