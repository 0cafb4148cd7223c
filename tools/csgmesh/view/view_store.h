/* SPDX-License-Identifier: MIT
 * What the page is shown: the state as JSON, and the latest model as bytes. The builder's thread
 * puts them there, the server's threads take copies; each change has a number that grows.
 */
#ifndef CLI_VIEW_STORE_H
#define CLI_VIEW_STORE_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct view_store {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t version; /* of the state; 0: there is none yet */
    char *state;      /* the members of a JSON object, without its brackets */
    uint64_t model_number;
    char *model;
    size_t model_length;
    bool is_ending;
} view_store;

bool view_store_begin(view_store *store);
/* Wakes all who wait; they get nothing any more. */
void view_store_end(view_store *store);
bool view_store_is_ending(view_store *store);
/* After all threads that use it. */
void view_store_release(view_store *store);

/* members: from malloc, the store's from here on; NULL: out of memory, nothing changes. */
void view_store_set_state(view_store *store, char *members);
/* The same for a model; returns its number. */
uint64_t view_store_set_model(view_store *store, char *model, size_t length);

/* The state as a JSON object whose "version" is larger than `after`, once there is one, for the
 * caller to free; NULL: not within so many seconds. */
char *view_store_wait(view_store *store, uint64_t after, double seconds);
/* A copy for the caller to free; NULL: there is a later one, or none of this number. */
char *view_store_copy_model(view_store *store, uint64_t number, size_t *length);

#endif
