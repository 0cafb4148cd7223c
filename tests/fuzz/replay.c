/* SPDX-License-Identifier: MIT
 * Runs a fuzz target over files: all of the given folders, and the given files. With any compiler,
 * so that every finding stays a test. --mutate COUNT PERCENT before them: each file and COUNT
 * changed ones, by the target's own mutator, of which PERCENT must be taken by the reader: a
 * mutator that breaks what it should keep fails.
 */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "fuzz/mutate.h"

enum { ROOM = 1 << 16 };

#pragma weak LLVMFuzzerCustomMutator

static int mutations;

/* A byte changed, left out or put in. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most)
{
    static uint32_t random = 1;
    random = random * 1664525 + 1013904223;
    size_t at = size ? (random >> 8) % size : 0;
    uint8_t byte = (uint8_t)(random >> 24);
    switch (random >> 5 & 3) {
    case 0:
        if (size < most) {
            memmove(data + at + 1, data + at, size - at);
            data[at] = byte;
            return size + 1;
        }
        break;
    case 1:
        if (size > 1) {
            memmove(data + at, data + at + 1, size - at - 1);
            return size - 1;
        }
        break;
    default:
        break;
    }
    if (size)
        data[at] = byte;
    return size;
}

/* Exactly its size, so that sanitizers see the end. */
static void run_copy(const uint8_t *bytes, size_t size)
{
    uint8_t *data = malloc(size ? size : 1);
    if (!data)
        exit(1);
    memcpy(data, bytes, size);
    LLVMFuzzerTestOneInput(data, size);
    free(data);
}

static void run_mutated(const uint8_t *bytes, size_t size)
{
    static uint8_t room[ROOM];
    if (size > ROOM / 2)
        return;
    for (int i = 0; i < mutations; i++) {
        memcpy(room, bytes, size);
        size_t now = size;
        for (int times = 0; times <= i % 3; times++)
            now = LLVMFuzzerCustomMutator(room, now, ROOM, 3u * (unsigned)i + (unsigned)times + 7);
        run_copy(room, now);
    }
}

static int replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        perror(path);
        exit(1);
    }
    size_t size = (size_t)ftell(file);
    rewind(file);
    uint8_t *data = malloc(size ? size : 1); /* exactly its size: sanitizers see the end */
    if (!data || fread(data, 1, size, file) != size) {
        perror(path);
        exit(1);
    }
    fclose(file);
    fprintf(stderr, "%s\n", path); /* the last one named is the one that crashed */
    LLVMFuzzerTestOneInput(data, size);
    run_mutated(data, size);
    free(data);
    return 1;
}

static int replay(const char *path)
{
    DIR *folder = opendir(path);
    int count = 0;
    if (!folder)
        return replay_file(path);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char full[4096];
        snprintf(full, sizeof full, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.')
            count += replay_file(full);
    }
    closedir(folder);
    return count;
}

int main(int argument_count, char **arguments)
{
    int count = 0, first = 1, percent = 0;
    if (argument_count > 3 && strcmp(arguments[1], "--mutate") == 0 && LLVMFuzzerCustomMutator) {
        mutations = atoi(arguments[2]);
        percent = atoi(arguments[3]);
        first = 4;
    }
    for (int i = first; i < argument_count; i++)
        count += replay(arguments[i]);
    uint64_t inputs = (uint64_t)count * (uint64_t)(1 + mutations);
    printf("%llu inputs, %llu meshes\n", (unsigned long long)inputs,
           (unsigned long long)fuzz_accepted);
    return count == 0 || 100 * fuzz_accepted < (uint64_t)percent * inputs;
}
