/* SPDX-License-Identifier: MIT
 * HTTP by libcurl; see batch_http.h. The library is loaded with dlopen: linked in, it and the
 * thirty libraries that it needs would add 5 ms to every start of the program.
 *
 * No redirections: they might lead credentials elsewhere. The environment's proxies and ~/.netrc
 * (or $NETRC) count.
 */
#include "batch/batch_http.h"

#include <string.h>
#include <strings.h>

bool batch_http_is_address(const char *text)
{
    return text && (strncasecmp(text, "http://", 7) == 0 || strncasecmp(text, "https://", 8) == 0);
}

#ifndef CLI_HAS_CURL

const char *batch_http_feature(void)
{
    return "without libcurl (missing: caches over HTTP)";
}

bool batch_http_available(void)
{
    return false;
}

batch_http *batch_http_open(const batch_http_options *options, char reason[BATCH_HTTP_REASON])
{
    (void)options;
    reason[0] = '\0';
    return NULL;
}

void batch_http_close(batch_http *http)
{
    (void)http;
}

const char *batch_http_shown(const batch_http *http)
{
    (void)http;
    return "";
}

long batch_http_get(batch_http *http, const char *path, uint64_t expected, batch_http_sink *sink,
                    void *user, char reason[BATCH_HTTP_REASON])
{
    (void)http, (void)path, (void)expected, (void)sink, (void)user, (void)reason;
    return 0;
}

long batch_http_put(batch_http *http, const char *path, const char *bytes, int fd, uint64_t count,
                    char reason[BATCH_HTTP_REASON])
{
    (void)http, (void)path, (void)bytes, (void)fd, (void)count, (void)reason;
    return 0;
}

#else

#define CURL_DISABLE_TYPECHECK
#include <curl/curl.h>
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "csgmesh/csgmesh.h"

const char *batch_http_feature(void)
{
    return "with libcurl " CLI_HAS_CURL " (caches over HTTP; loaded when it is used)";
}

bool batch_http_available(void)
{
    return true;
}

/* ---- the library ---------------------------------------------------------------------- */

#define EACH_FUNCTION(DO)                                                                          \
    DO(curl_global_init)                                                                           \
    DO(curl_easy_init)                                                                             \
    DO(curl_easy_setopt)                                                                           \
    DO(curl_easy_perform)                                                                          \
    DO(curl_easy_getinfo)                                                                          \
    DO(curl_easy_strerror)                                                                         \
    DO(curl_easy_reset)                                                                            \
    DO(curl_easy_cleanup)                                                                          \
    DO(curl_slist_append)                                                                          \
    DO(curl_slist_free_all)

static struct {
#define MEMBER(name) __typeof__(&(name)) name;
    EACH_FUNCTION(MEMBER)
#undef MEMBER
    const char *problem; /* NULL: it is there */
} library;

static void load(void)
{
#ifdef __APPLE__
    static const char name[] = "libcurl.4.dylib";
#else
    static const char name[] = "libcurl.so.4";
#endif
    char path[4096]; /* where it was when this was built, if the loader does not know a place */
    snprintf(path, sizeof path, "%s/%s", CLI_CURL_FOLDER, name);
    void *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    handle = handle ? handle : dlopen(path, RTLD_NOW | RTLD_LOCAL);
    bool whole = handle != NULL;
#define LOOK_UP(function)                                                                          \
    do {                                                                                           \
        void *address = handle ? dlsym(handle, #function) : NULL;                                  \
        memcpy(&library.function, &address, sizeof address);                                       \
        whole = whole && address;                                                                  \
    } while (0);
    EACH_FUNCTION(LOOK_UP)
#undef LOOK_UP
    if (!whole || library.curl_global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK)
        library.problem = "libcurl (libcurl.so.4) cannot be loaded";
}

static const char *load_once(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    return library.problem;
}

/* ---- the server ----------------------------------------------------------------------- */

enum { IDLE_MOST = 64 };

struct batch_http {
    batch_http_options options;
    char *address; /* without user and password, and without a slash at its end */
    char *user, *password;
    struct curl_slist *headers;
    pthread_mutex_t mutex;
    CURL *idle[IDLE_MOST]; /* with connections that may be open still */
    size_t idle_count;
};

/* "%41" -> "A", in place. */
static void decode(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++) {
        char code[3] = {from[0] == '%' ? from[1] : '\0', '\0', '\0'}, *end;
        code[1] = code[0] ? from[2] : '\0';
        long value = code[1] ? strtol(code, &end, 16) : 0;
        if (code[1] && !*end && value > 0) {
            *to++ = (char)value;
            from += 2;
        } else {
            *to++ = *from;
        }
    }
    *to = '\0';
}

/* "http://user:password@host/path/" -> its pieces. false: no memory, or no address. */
static bool split(batch_http *http, const char *address)
{
    const char *host = strstr(address, "//") + 2, *end = host + strcspn(host, "/?#");
    const char *at = NULL;
    for (const char *c = host; c < end; c++)
        at = *c == '@' ? c : at;
    size_t scheme = (size_t)(host - address), rest;
    host = at ? at + 1 : host;
    for (rest = strlen(host); rest && host[rest - 1] == '/';)
        rest--;
    http->address = malloc(scheme + rest + 1);
    if (!http->address || host == end || strpbrk(host, "?#"))
        return false;
    memcpy(http->address, address, scheme);
    memcpy(http->address + scheme, host, rest);
    http->address[scheme + rest] = '\0';
    if (!at)
        return true;
    http->user = strndup(address + scheme, (size_t)(at - address) - scheme);
    char *colon = http->user ? strchr(http->user, ':') : NULL;
    http->password = strdup(colon ? colon + 1 : "");
    if (!http->user || !http->password)
        return false;
    if (colon)
        *colon = '\0';
    decode(http->user);
    decode(http->password);
    return true;
}

static bool add_header(batch_http *http, const char *name, const char *value)
{
    size_t size = strlen(name) + strlen(value) + 1;
    char *line = malloc(size);
    if (!line)
        return false;
    snprintf(line, size, "%s%s", name, value);
    struct curl_slist *more = library.curl_slist_append(http->headers, line);
    free(line);
    http->headers = more ? more : http->headers;
    return more != NULL;
}

batch_http *batch_http_open(const batch_http_options *options, char reason[BATCH_HTTP_REASON])
{
    const char *problem = load_once();
    batch_http *http = problem ? NULL : calloc(1, sizeof *http);
    snprintf(reason, BATCH_HTTP_REASON, "%s", problem ? problem : "out of memory");
    if (!http)
        return NULL;
    http->options = *options;
    pthread_mutex_init(&http->mutex, NULL);
    bool is_address = split(http, options->address);
    if (is_address && add_header(http, "Expect:", "") &&
        (!options->token || add_header(http, "Authorization: Bearer ", options->token)))
        return http;
    if (!is_address)
        snprintf(reason, BATCH_HTTP_REASON, "this is no address of a cache");
    batch_http_close(http);
    return NULL;
}

void batch_http_close(batch_http *http)
{
    if (!http)
        return;
    for (size_t i = 0; i < http->idle_count; i++)
        library.curl_easy_cleanup(http->idle[i]);
    library.curl_slist_free_all(http->headers);
    pthread_mutex_destroy(&http->mutex);
    free(http->address);
    free(http->user);
    free(http->password);
    free(http);
}

const char *batch_http_shown(const batch_http *http)
{
    return http->address;
}

/* ---- a request ------------------------------------------------------------------------ */

typedef struct request {
    batch_http *http;
    CURL *curl;
    char *address;
    batch_http_sink *sink; /* NULL: the answer is not looked at */
    void *user;
    const char *bytes; /* to be sent, or of the file */
    int fd;
    uint64_t count, at;
    uint64_t heard; /* bytes that nobody takes */
    bool is_ended;  /* by the sink or is_over */
    char error[CURL_ERROR_SIZE];
} request;

static CURL *take_handle(batch_http *http)
{
    pthread_mutex_lock(&http->mutex);
    CURL *curl = http->idle_count ? http->idle[--http->idle_count] : NULL;
    pthread_mutex_unlock(&http->mutex);
    return curl ? curl : library.curl_easy_init();
}

static void give_back(batch_http *http, CURL *curl)
{
    library.curl_easy_reset(curl); /* the connection stays */
    pthread_mutex_lock(&http->mutex);
    bool kept = http->idle_count < IDLE_MOST;
    if (kept)
        http->idle[http->idle_count++] = curl;
    pthread_mutex_unlock(&http->mutex);
    if (!kept)
        library.curl_easy_cleanup(curl);
}

static size_t take_bytes(char *bytes, size_t size, size_t count, void *user)
{
    enum { WORDS = 1 << 16 }; /* of an error's page */
    request *r = user;
    long status = 0;
    library.curl_easy_getinfo(r->curl, CURLINFO_RESPONSE_CODE, &status);
    bool goes_on = true;
    if (r->sink && status == 200)
        goes_on = r->sink(r->user, bytes, size * count);
    else
        goes_on = (r->heard += size * count) <= WORDS;
    r->is_ended = r->is_ended || (!goes_on && r->sink && status == 200);
    return goes_on ? size * count : 0; /* 0: it fails */
}

static size_t give_bytes(char *buffer, size_t size, size_t count, void *user)
{
    request *r = user;
    uint64_t left = r->count - r->at, most = size * count;
    size_t wanted = (size_t)(left < most ? left : most);
    if (r->bytes)
        memcpy(buffer, r->bytes + r->at, wanted);
    for (size_t got = 0; !r->bytes && got < wanted;) {
        ssize_t piece = pread(r->fd, buffer + got, wanted - got, (off_t)(r->at + got));
        if (piece < 0 && errno == EINTR)
            continue;
        if (piece <= 0)
            return CURL_READFUNC_ABORT;
        got += (size_t)piece;
    }
    r->at += wanted;
    return wanted;
}

/* Where the connection had been closed meanwhile, it is sent again. */
static int start_again(void *user, curl_off_t offset, int origin)
{
    request *r = user;
    if (origin != SEEK_SET || offset < 0 || (uint64_t)offset > r->count)
        return CURL_SEEKFUNC_FAIL;
    r->at = (uint64_t)offset;
    return CURL_SEEKFUNC_OK;
}

static int look_around(void *user, curl_off_t a, curl_off_t b, curl_off_t c, curl_off_t d)
{
    request *r = user;
    (void)a, (void)b, (void)c, (void)d;
    const batch_http_options *options = &r->http->options;
    r->is_ended = r->is_ended || (options->is_over && options->is_over(options->user));
    return r->is_ended;
}

/* Slower than this it is as good as dead. */
enum { LEAST_BYTES_PER_S = 1024, SUPPOSED_BYTES_PER_S = 65536 };

static void prepare(request *r, uint64_t expected)
{
    const batch_http *http = r->http;
    double patience_s = http->options.patience_s;
    double longest_s = 4 * patience_s + (double)expected / SUPPOSED_BYTES_PER_S;
    const char *netrc = getenv("NETRC");
#define SET(option, value) library.curl_easy_setopt(r->curl, option, value)
    SET(CURLOPT_URL, r->address);
    SET(CURLOPT_ERRORBUFFER, r->error);
    SET(CURLOPT_NOSIGNAL, 1L);
    SET(CURLOPT_USERAGENT, "csgmesh");
    SET(CURLOPT_HTTPHEADER, http->headers);
    SET(CURLOPT_NETRC, (long)CURL_NETRC_OPTIONAL);
    if (netrc && *netrc)
        SET(CURLOPT_NETRC_FILE, netrc);
    if (http->user) {
        SET(CURLOPT_USERNAME, http->user);
        SET(CURLOPT_PASSWORD, http->password);
    }
    SET(CURLOPT_CONNECTTIMEOUT_MS, (long)(patience_s * 1000));
    SET(CURLOPT_LOW_SPEED_LIMIT, (long)LEAST_BYTES_PER_S);
    SET(CURLOPT_LOW_SPEED_TIME, (long)(patience_s + 0.999));
    SET(CURLOPT_TIMEOUT_MS, (long)(longest_s * 1000));
    SET(CURLOPT_WRITEFUNCTION, take_bytes);
    SET(CURLOPT_WRITEDATA, r);
    SET(CURLOPT_NOPROGRESS, 0L);
    SET(CURLOPT_XFERINFOFUNCTION, look_around);
    SET(CURLOPT_XFERINFODATA, r);
    if (!r->sink) {
        SET(CURLOPT_UPLOAD, 1L);
        SET(CURLOPT_INFILESIZE_LARGE, (curl_off_t)r->count);
        SET(CURLOPT_READFUNCTION, give_bytes);
        SET(CURLOPT_READDATA, r);
        SET(CURLOPT_SEEKFUNCTION, start_again);
        SET(CURLOPT_SEEKDATA, r);
    }
#undef SET
}

static long perform(request *r, const char *path, uint64_t expected, char reason[BATCH_HTTP_REASON])
{
    batch_http *http = r->http;
    size_t size = strlen(http->address) + strlen(path) + 1;
    long status = 0;
    snprintf(reason, BATCH_HTTP_REASON, "out of memory");
    r->address = malloc(size);
    r->curl = r->address ? take_handle(http) : NULL;
    if (r->curl) {
        snprintf(r->address, size, "%s%s", http->address, path);
        prepare(r, expected);
        CURLcode result = library.curl_easy_perform(r->curl);
        if (result == CURLE_OK)
            library.curl_easy_getinfo(r->curl, CURLINFO_RESPONSE_CODE, &status);
        else
            snprintf(reason, BATCH_HTTP_REASON, "%s",
                     r->is_ended   ? ""
                     : r->error[0] ? r->error
                                   : library.curl_easy_strerror(result));
        give_back(http, r->curl);
    }
    free(r->address);
    return status;
}

long batch_http_get(batch_http *http, const char *path, uint64_t expected, batch_http_sink *sink,
                    void *user, char reason[BATCH_HTTP_REASON])
{
    request r = {.http = http, .sink = sink, .user = user, .fd = -1};
    return perform(&r, path, expected, reason);
}

long batch_http_put(batch_http *http, const char *path, const char *bytes, int fd, uint64_t count,
                    char reason[BATCH_HTTP_REASON])
{
    request r = {.http = http, .bytes = bytes, .fd = fd, .count = count};
    return perform(&r, path, count, reason);
}

#endif
