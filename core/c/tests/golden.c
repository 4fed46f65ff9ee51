/* The job "rope" of tests/firmware, from C: a rope of 30 particles, digested after every step, printed as golden.txt has
 * it. What is printed must be that file's text, in either precision and on every machine. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hooke.h"

enum { PARTICLES = 30, STEPS = 60, PER_LINE = 12 };

static union {
    double alignment;
    unsigned char bytes[512 * (PARTICLES + 1)];
} buffer;

static void check(hooke_status status) {
    if (status != HOOKE_OK) {
        printf("%s\n", hooke_message(status));
        exit(EXIT_FAILURE);
    }
}

/* FNV-1a of numbers as little-endian doubles, which hold a float exactly. */
static uint64_t digest_of(uint64_t digest, const float *numbers, size_t count) {
    size_t i;
    unsigned shift;
    for (i = 0; i < count; i++) {
        const double number = numbers[i];
        uint64_t bits;
        memcpy(&bits, &number, sizeof bits);
        for (shift = 0; shift < 64; shift += 8) {
            digest = (digest ^ (bits >> shift & 0xff)) * 0x100000001b3u;
        }
    }
    return digest;
}

int main(void) {
    static float state[2][PARTICLES][3];
    hooke_f32 *rope;
    hooke_f32_options options;
    hooke_f32_report report;
    uint64_t digest = 0xcbf29ce484222325u;
    unsigned long iterations = 0, clamped = 0;
    size_t i, step;

    check(hooke_f32_init(&buffer, sizeof buffer, PARTICLES, PARTICLES - 1, &rope));
    for (i = 0; i < PARTICLES; i++) {
        const float position[3] = {(float)(0.1 * (int)i), 0, (float)(0.01 * (int)(i % 3))};
        check(hooke_f32_add_particle(rope, position, (float)0.01, NULL));
        if (i > 0) {
            check(hooke_f32_add_spring(rope, i - 1, i, 1000, NULL));
        }
    }
    check(hooke_f32_pin(rope, 0));
    check(hooke_f32_defaults(&options));
    options.dt = (float)1 / 60;
    options.gravity[1] = (float)-9.81;
    check(hooke_f32_set_options(rope, &options));

    printf("job rope f32");
    for (step = 0; step < STEPS; step++) {
        check(hooke_f32_step(rope, &report));
        iterations += report.iterations;
        clamped += report.clamped;
        check(hooke_f32_positions(rope, state[0][0], PARTICLES));
        check(hooke_f32_velocities(rope, state[1][0], PARTICLES));
        digest = digest_of(digest, state[0][0], sizeof state / sizeof state[0][0][0]);
        printf("%s%08lx", step % PER_LINE ? " " : "\n ", (unsigned long)(digest >> 32));
    }
    printf("\nend %d steps %lu iterations %lu clamped %08lx%08lx\n", STEPS, iterations, clamped,
           (unsigned long)(digest >> 32), (unsigned long)(digest & 0xffffffffu));
    return 0;
}
