/* A hanging rope whose top is moved to and fro, the tip struck, a link stiffened, another torn. Prints what a haptic
 * device would read, and last a digest of every bit of the trajectory: the same on every machine (see tests/check.sh). */

#include <stdio.h>
#include <stdlib.h>

#include "hooke.h"

enum { LINKS = 23, PARTICLES = LINKS + 1, STEPS = 256 };

/* Static memory for the scene: the library has none. calloc(1, hooke_f32_size(...)) would do as well. The union aligns
 * it; its size is an upper estimate that hooke_f32_init checks. */
static union {
    double alignment;
    unsigned char bytes[512 * (PARTICLES + 1)];
} buffer;

static hooke_f32 *rope;

/* No call is left unchecked: what is refused says why, and about which particle or spring. */
static void check(hooke_status status) {
    if (status != HOOKE_OK) {
        printf("%s (%ld)\n", hooke_message(status), rope ? (long)hooke_f32_last_index(rope) : -1L);
        exit(EXIT_FAILURE);
    }
}

static uint64_t fnv(uint64_t digest, const void *data, size_t bytes) {
    const unsigned char *byte = data;
    size_t i;
    for (i = 0; i < bytes; i++) {
        digest = (digest ^ byte[i]) * 0x100000001b3u;
    }
    return digest;
}

int main(void) {
    static float state[2][PARTICLES][3];
    hooke_f32_options options;
    hooke_f32_report report;
    hooke_f32_motion hand = {0, {0, 0, 0}, {0, 0, 0}};
    const float strike[3] = {0, 0, 0.03125f};
    uint64_t digest = 0xcbf29ce484222325u;
    size_t i, step;

    check(hooke_f32_init(&buffer, sizeof buffer, PARTICLES, LINKS, &rope));
    for (i = 0; i < PARTICLES; i++) {
        const float position[3] = {(float)i / 16, 0, 0};
        check(hooke_f32_add_particle(rope, position, 0.0078125f, NULL));
        if (i > 0) {
            check(hooke_f32_add_spring(rope, i - 1, i, 500, NULL));
        }
    }
    check(hooke_f32_pin(rope, 0));

    check(hooke_f32_defaults(&options));
    options.dt = 0.015625f;
    options.gravity[1] = -9.8125f;
    options.drag = 0.125f;
    options.damping = 0.25f;
    options.max_iterations = 20; /* a bounded time per step; the report says how exact that was */
    check(hooke_f32_set_options(rope, &options));

    for (step = 1; step <= STEPS; step++) {
        hand.velocity[0] = step % 128 < 64 ? 0.5f : -0.5f; /* a sensor's values */
        hand.position[0] += hand.velocity[0] * options.dt;
        check(hooke_f32_step_moving(rope, &hand, 1, &report));

        check(hooke_f32_positions(rope, state[0][0], PARTICLES));
        check(hooke_f32_velocities(rope, state[1][0], PARTICLES));
        digest = fnv(digest, state, sizeof state);
        if (step % 64 == 0) {
            float force[3], tension;
            check(hooke_f32_reaction(rope, 0, force));
            check(hooke_f32_tension(rope, 0, &tension));
            printf("step %3u: tip (%+.3f, %+.3f, %+.3f) m, hand holds (%+.3f, %+.3f) N, top link %.3f N, %u iterations, "
                   "error at most %.1e J\n",
                   (unsigned)step, state[0][LINKS][0], state[0][LINKS][1], state[0][LINKS][2], force[0], force[1],
                   tension, (unsigned)report.iterations, report.upper);
        }
        switch (step) {
        case 64: check(hooke_f32_impulse(rope, LINKS, strike)); break;
        case 128: check(hooke_f32_set_stiffness(rope, 3, 1000)); break;
        case 192: check(hooke_f32_break_spring(rope, LINKS / 2)); break;
        }
    }
    printf("digest f32 %08lx%08lx\n", (unsigned long)(digest >> 32), (unsigned long)(digest & 0xffffffffu));
    return 0;
}
