/* Reads a world from C: heights at points, a window, the chunks around a walking viewer, and objects.
 *
 *     cargo build --release -p orogen-c
 *     cc -std=c11 -I crates/orogen-c/include crates/orogen-c/examples/world.c -L target/release -lorogen -o world
 *     LD_LIBRARY_PATH=target/release ./world hills
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "orogen.h"

/* Ends the program with the library's message after an error. */
static void check(OrogenStatus status) {
    if (status != OROGEN_OK) {
        fprintf(stderr, "error: %s\n", orogen_error());
        exit(1);
    }
}

static void *there(void *pointer) {
    if (pointer == NULL) {
        fprintf(stderr, "error: %s\n", orogen_error());
        exit(1);
    }
    return pointer;
}

int main(int count, char **arguments) {
    const char *source = count > 1 ? arguments[1] : "hills";
    OrogenWorld *world = there(orogen_world_open(source));
    OrogenWorldInfo info;
    check(orogen_world_info(world, &info));
    printf("orogen %s, %s: %g x %g m, cell %g m, seed %" PRIu64 "\n", orogen_version(), source, info.width, info.height, info.cell,
           info.seed);

    /* A window: 5 x 4 samples from (1000, 2000) m on, one every 100 m. */
    OrogenWindow window = {.x = 10, .y = 20, .width = 5, .height = 4, .cell = 100.0};
    float heights[5 * 4];
    check(orogen_world_window(world, "height", window, heights, 5 * 4));
    for (size_t j = 0; j < window.height; j++) {
        for (size_t i = 0; i < window.width; i++) printf("%a%c", heights[j * window.width + i], i + 1 < window.width ? ' ' : '\n');
    }

    /* The same samples one by one. */
    OrogenSampler *ground = there(orogen_sampler_new(world, "height"));
    double x[] = {1000.0, 1100.0}, y[] = {2000.0, 2300.0};
    float at[2];
    check(orogen_sampler_points(ground, x, y, 2, at));
    printf("points %a %a\n", at[0], at[1]);

    /* The chunks around a viewer who walks east. */
    OrogenLod lod = orogen_lod_default();
    lod.cells = 16;
    lod.cell = 10.0;
    lod.levels = 3;
    lod.range = 600.0;
    OrogenChunks *chunks = there(orogen_chunks_new(world, lod));
    float *buffer = there(malloc((lod.cells + 1) * (lod.cells + 1) * sizeof(float)));
    size_t made = 0, dropped = 0;
    for (int step = 0; step < 10; step++) {
        OrogenChunk chunk;
        bool has;
        check(orogen_chunks_set_viewer(chunks, 2000.0 + 100.0 * step, 2000.0));
        for (check(orogen_chunks_take(chunks, &chunk, &has)); has; check(orogen_chunks_take(chunks, &chunk, &has))) {
            OrogenWindow samples;
            check(orogen_chunks_window(chunks, chunk, &samples));
            check(orogen_sampler_window(ground, samples, buffer, (lod.cells + 1) * (lod.cells + 1)));
            check(orogen_chunks_done(chunks, chunk));
            made++;
        }
        for (check(orogen_chunks_evict(chunks, &chunk, &has)); has; check(orogen_chunks_evict(chunks, &chunk, &has))) dropped++;
    }
    printf("chunks made %zu, dropped %zu\n", made, dropped);

    /* Objects, if the recipe has some. */
    OrogenWindow part = {.x = 0, .y = 0, .width = 50, .height = 50, .cell = info.cell};
    OrogenObjects *objects = orogen_objects_new(world, part);
    if (objects == NULL) {
        printf("no objects: %s\n", orogen_error());
    } else {
        const OrogenObject *list;
        size_t number;
        check(orogen_objects_list(objects, &list, &number));
        printf("objects %zu", number);
        if (number > 0) printf(", the first is of kind %s at %g, %g", orogen_objects_kind(objects, list[0].kind), list[0].x, list[0].y);
        printf("\n");
        orogen_objects_free(objects);
    }

    /* What is wrong is said, and nothing else happens. */
    if (orogen_world_window(world, "heigth", window, heights, 5 * 4) != OROGEN_OK) printf("message: %s\n", orogen_error());

    free(buffer);
    orogen_chunks_free(chunks);
    orogen_sampler_free(ground);
    orogen_world_free(world);
    return 0;
}
