/* SPDX-License-Identifier: MIT
 * One lock around two texts; see view_store.h.
 */
#include "view/view_store.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

bool view_store_begin(view_store *store)
{
    *store = (view_store){.version = 0};
    return pthread_mutex_init(&store->lock, NULL) == 0 &&
           pthread_cond_init(&store->changed, NULL) == 0;
}

void view_store_end(view_store *store)
{
    pthread_mutex_lock(&store->lock);
    store->is_ending = true;
    pthread_cond_broadcast(&store->changed);
    pthread_mutex_unlock(&store->lock);
}

bool view_store_is_ending(view_store *store)
{
    pthread_mutex_lock(&store->lock);
    bool is_ending = store->is_ending;
    pthread_mutex_unlock(&store->lock);
    return is_ending;
}

void view_store_release(view_store *store)
{
    free(store->state);
    free(store->model);
    pthread_cond_destroy(&store->changed);
    pthread_mutex_destroy(&store->lock);
}

void view_store_set_state(view_store *store, char *members)
{
    if (!members)
        return;
    pthread_mutex_lock(&store->lock);
    free(store->state);
    store->state = members;
    store->version++;
    pthread_cond_broadcast(&store->changed);
    pthread_mutex_unlock(&store->lock);
}

uint64_t view_store_set_model(view_store *store, char *model, size_t length)
{
    pthread_mutex_lock(&store->lock);
    if (model) {
        free(store->model);
        store->model = model;
        store->model_length = length;
        store->model_number++;
    }
    uint64_t number = store->model_number;
    pthread_mutex_unlock(&store->lock);
    return number;
}

/* pthread_cond_timedwait counts by the wall clock; if that is set back, a wait lasts longer. */
static struct timespec time_after(double seconds)
{
    struct timespec at;
    clock_gettime(CLOCK_REALTIME, &at);
    double nanoseconds = (double)at.tv_nsec + 1e9 * seconds;
    at.tv_sec += (time_t)(nanoseconds / 1e9);
    at.tv_nsec = (long)(nanoseconds - 1e9 * (double)(time_t)(nanoseconds / 1e9));
    return at;
}

char *view_store_wait(view_store *store, uint64_t after, double seconds)
{
    struct timespec end = time_after(seconds);
    char *text = NULL;
    pthread_mutex_lock(&store->lock);
    while (store->version <= after && !store->is_ending)
        if (pthread_cond_timedwait(&store->changed, &store->lock, &end) != 0)
            break;
    if (store->version > after && !store->is_ending) {
        size_t size = strlen(store->state) + 64;
        text = malloc(size);
        if (text)
            snprintf(text, size, "{\"version\":%" PRIu64 ",%s}", store->version, store->state);
    }
    pthread_mutex_unlock(&store->lock);
    return text;
}

char *view_store_copy_model(view_store *store, uint64_t number, size_t *length)
{
    char *copy = NULL;
    pthread_mutex_lock(&store->lock);
    if (store->model && number == store->model_number) {
        copy = malloc(store->model_length);
        if (copy)
            memcpy(copy, store->model, store->model_length);
        *length = store->model_length;
    }
    pthread_mutex_unlock(&store->lock);
    return copy;
}
