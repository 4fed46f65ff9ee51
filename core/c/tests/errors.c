/* Every bad input that hooke.h says is noticed: its code, the index it is about, and the scene as it was. "As it was"
 * means: every byte of the buffer but the noted index and what a step uses as scratch, and the next steps bit for bit. */

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hooke.h"

enum { PARTICLES = 5, SPRINGS = 4, NOTED = 777 };
#define NONE HOOKE_NO_INDEX

static unsigned failures, checks;
static size_t size;
static unsigned char *before, *elsewhere; /* copies of the scene's buffer */
static hooke_f32 *scene;

static void fail(int line, const char *what, const char *why, long got) {
    printf("errors.c:%d: %s: %s (%ld)\n", line, what, why, got);
    failures++;
}

typedef struct {
    hooke_status status;
    size_t counts[2];
    float state[2][PARTICLES][3];
} future;

/* What becomes of a scene, found out on a copy at another address. */
static void look_ahead(const void *buffer, future *then) {
    hooke_f32 *copy = (hooke_f32 *)elsewhere;
    int step;
    memset(then, 0, sizeof *then);
    memcpy(elsewhere, buffer, size);
    for (step = 0; step < 3 && then->status == HOOKE_OK; step++) {
        then->status = hooke_f32_step(copy, NULL);
    }
    hooke_f32_particles(copy, &then->counts[0]);
    hooke_f32_springs(copy, &then->counts[1]);
    hooke_f32_positions(copy, then->state[0][0], PARTICLES);
    hooke_f32_velocities(copy, then->state[1][0], PARTICLES);
}

static void refused(int line, const char *what, int scratch, hooke_status expected, size_t index, hooke_status got) {
    future was, is;
    checks++;
    if (got != expected) {
        fail(line, what, hooke_message(got), got);
    }
    if (hooke_f32_last_index(scene) != index) {
        fail(line, what, "the index", (long)hooke_f32_last_index(scene));
    }
    look_ahead(before, &was);
    look_ahead(scene, &is);
    if (memcmp(&was, &is, sizeof is) != 0) {
        fail(line, what, "the scene goes on in another way", 0);
    }
    hooke_f32_pin(scene, NOTED); /* which notes the index that was noted before */
    if (!scratch && memcmp(before, scene, size) != 0) {
        fail(line, what, "the buffer has changed", 0);
    }
}

#define SAVE (hooke_f32_pin(scene, NOTED), memcpy(before, scene, size))
#define REFUSED(status, index, call) (SAVE, refused(__LINE__, #call, 0, status, index, call))
#define STEP_REFUSED(status, index, call) (SAVE, refused(__LINE__, #call, 1, status, index, call))
#define SAME(expected, call) same(__LINE__, #call, (long)(expected), (long)(call))

static void same(int line, const char *what, long expected, long got) {
    checks++;
    if (got != expected) {
        fail(line, what, "answers otherwise", got);
    }
}

/* p, one byte further: a pointer that is aligned for nothing. */
static void *off(void *p) {
    return (unsigned char *)p + 1;
}

static void buffers(void) {
    unsigned char *raw = calloc(1, size + 8), *copy = calloc(1, size);
    hooke_f32 *handle = NULL;
    size_t i, n;
    SAME(0, hooke_f32_size(SIZE_MAX, 1));
    SAME(0, hooke_f32_size(1, SIZE_MAX / 8));
    SAME(HOOKE_NULL, hooke_f32_init(NULL, size, PARTICLES, SPRINGS, &handle));
    SAME(HOOKE_NULL, hooke_f32_init(raw, size, PARTICLES, SPRINGS, NULL));
    SAME(HOOKE_MISALIGNED, hooke_f32_init(off(raw), size, PARTICLES, SPRINGS, &handle));
    SAME(HOOKE_MISALIGNED, hooke_f32_init(raw, size, PARTICLES, SPRINGS, off(&handle)));
    SAME(HOOKE_TOO_SMALL, hooke_f32_init(raw, size - 1, PARTICLES, SPRINGS, &handle));
    SAME(HOOKE_TOO_SMALL, hooke_f32_init(raw, 0, 0, 0, &handle));
    SAME(HOOKE_TOO_LARGE, hooke_f32_init(raw, size, SIZE_MAX, 0, &handle));
    SAME(HOOKE_TOO_LARGE, hooke_f32_init(raw, size, 0, SIZE_MAX / 4, &handle));
    SAME(HOOKE_OVERLAP, hooke_f32_init(raw, size, PARTICLES, SPRINGS, (hooke_f32 **)(void *)(raw + 16)));
    SAME(1, handle == NULL && memcmp(raw, copy, size) == 0); /* none of them has written anything */

    /* No scene in it: null, misaligned, zeros, rubbish, the other precision, any byte of its sizes changed. */
    SAME(HOOKE_NULL, hooke_f32_step(NULL, NULL));
    SAME(HOOKE_MISALIGNED, hooke_f32_step(off(raw), NULL));
    SAME(HOOKE_NOT_A_SCENE, hooke_f32_step((hooke_f32 *)(void *)raw, NULL));
    SAME(NONE, hooke_f32_last_index((hooke_f32 *)(void *)raw));
    SAME(NONE, hooke_f32_last_index(NULL));
    memset(raw, 0xa5, size);
    SAME(HOOKE_NOT_A_SCENE, hooke_f32_particles((hooke_f32 *)(void *)raw, &n));
    SAME(HOOKE_OK, hooke_f32_init(raw, size, PARTICLES, SPRINGS, &handle));
    SAME(1, (void *)handle == (void *)raw);
    SAME(HOOKE_NOT_A_SCENE, hooke_f64_step((void *)raw, NULL));
    for (i = 0; i < 40; i++) { /* magic word, checksum, capacity, counts */
        raw[i] ^= 0x10;
        SAME(HOOKE_NOT_A_SCENE, hooke_f32_particles(handle, &n));
        raw[i] ^= 0x10;
    }
    SAME(HOOKE_OK, hooke_f32_particles(handle, &n));
    free(raw);
    free(copy);
}

static void building(void) {
    float x[4] = {0, 0, 0, 0}, nan[3] = {0, NAN, 0};
    size_t i, index = NONE;
    REFUSED(HOOKE_NO_OPTIONS, NONE, hooke_f32_step(scene, NULL));
    REFUSED(HOOKE_NO_OPTIONS, NONE, hooke_f32_reaction(scene, 0, x));
    REFUSED(HOOKE_NULL, NONE, hooke_f32_add_particle(scene, NULL, 1, &index));
    REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_add_particle(scene, off(x), 1, &index));
    REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_add_particle(scene, x, 1, off(&index)));
    REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_add_particle(scene, (float *)(void *)scene, 1, &index));
    REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_add_particle(scene, x, 1, (size_t *)(void *)scene));
    REFUSED(HOOKE_NOT_FINITE, 0, hooke_f32_add_particle(scene, nan, 1, &index));
    REFUSED(HOOKE_MASS, 0, hooke_f32_add_particle(scene, x, 0, &index));
    REFUSED(HOOKE_MASS, 0, hooke_f32_add_particle(scene, x, -1, &index));
    REFUSED(HOOKE_MASS, 0, hooke_f32_add_particle(scene, x, NAN, &index));
    REFUSED(HOOKE_MASS, 0, hooke_f32_add_particle(scene, x, INFINITY, &index));
    SAME(1, index == NONE); /* refused calls answer nothing */
    for (i = 0; i < PARTICLES; i++) {
        x[0] = (float)i;
        SAME(HOOKE_OK, hooke_f32_add_particle(scene, x, 1, &index));
        SAME(i, index);
    }
    REFUSED(HOOKE_PARTICLES_FULL, PARTICLES, hooke_f32_add_particle(scene, x, 1, &index));
    REFUSED(HOOKE_NO_PARTICLE, 5, hooke_f32_add_spring(scene, 0, 5, 9, &index));
    REFUSED(HOOKE_NO_PARTICLE, SIZE_MAX, hooke_f32_add_spring(scene, SIZE_MAX, 0, 9, &index));
    REFUSED(HOOKE_SAME_ENDS, 0, hooke_f32_add_spring(scene, 2, 2, 9, &index));
    REFUSED(HOOKE_STIFFNESS, 0, hooke_f32_add_spring(scene, 0, 1, -1, &index));
    REFUSED(HOOKE_REST_LENGTH, 0, hooke_f32_add_spring_with(scene, 0, 1, 9, NAN, &index));
    REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_add_spring(scene, 0, 1, 9, off(&index)));
    for (i = 0; i < SPRINGS; i++) {
        SAME(HOOKE_OK, hooke_f32_add_spring_with(scene, i, i + 1, 100, 0.75f, &index));
        SAME(i, index);
    }
    REFUSED(HOOKE_SPRINGS_FULL, SPRINGS, hooke_f32_add_spring(scene, 0, 2, 9, NULL));
    SAME(HOOKE_OK, hooke_f32_pin(scene, 0));
}

static void options(void) {
    static hooke_f32_options good, bad; /* static: their padding, too, is defined for the comparison of bytes */
    SAME(HOOKE_NULL, hooke_f32_defaults(NULL));
    SAME(HOOKE_MISALIGNED, hooke_f32_defaults(off(&good)));
    SAME(HOOKE_OK, hooke_f32_defaults(&good));
    REFUSED(HOOKE_TIME_STEP, NONE, hooke_f32_set_options(scene, &good)); /* dt is the caller's to give */
    good.dt = 0.0625f;
    good.gravity[1] = -8;
    SAME(HOOKE_OK, hooke_f32_set_options(scene, &good));
#define BAD(field, value, status)                                                                                      \
    (bad = good, bad.field = value, REFUSED(status, NONE, hooke_f32_set_options(scene, &bad)))
    BAD(dt, -1, HOOKE_TIME_STEP);
    BAD(dt, NAN, HOOKE_TIME_STEP);
    BAD(dt, FLT_MIN, HOOKE_TIME_STEP); /* its square is 0 */
    BAD(dt, FLT_MAX, HOOKE_TIME_STEP); /* its square is infinite */
    BAD(tolerance, -1, HOOKE_TOLERANCE);
    BAD(absolute, NAN, HOOKE_TOLERANCE);
    BAD(gravity[2], INFINITY, HOOKE_FORCE);
    BAD(drag, -1, HOOKE_FORCE);
    BAD(damping, NAN, HOOKE_FORCE);
    REFUSED(HOOKE_NULL, NONE, hooke_f32_set_options(scene, NULL));
    REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_set_options(scene, off(&good)));
}

static void editing(void) {
    float x[3] = {1, 0, 0}, inf[3] = {INFINITY, 0, 0};
    SAME(HOOKE_OK, hooke_f32_break_spring(scene, 3));
    REFUSED(HOOKE_NO_PARTICLE, 5, hooke_f32_pin(scene, 5));
    REFUSED(HOOKE_NO_PARTICLE, 5, hooke_f32_release(scene, 5));
    REFUSED(HOOKE_NOT_PINNED, 1, hooke_f32_release(scene, 1));
    REFUSED(HOOKE_NO_PARTICLE, 9, hooke_f32_set_position(scene, 9, x));
    REFUSED(HOOKE_NOT_FINITE, 1, hooke_f32_set_position(scene, 1, inf));
    REFUSED(HOOKE_NULL, NONE, hooke_f32_set_position(scene, 1, NULL));
    REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_set_position(scene, 1, (float *)(void *)scene));
    REFUSED(HOOKE_PINNED, 0, hooke_f32_set_velocity(scene, 0, x));
    REFUSED(HOOKE_NOT_FINITE, 2, hooke_f32_set_velocity(scene, 2, inf));
    REFUSED(HOOKE_PINNED, 0, hooke_f32_impulse(scene, 0, x));
    REFUSED(HOOKE_NOT_FINITE, 2, hooke_f32_impulse(scene, 2, inf));
    REFUSED(HOOKE_MASS, 2, hooke_f32_set_mass(scene, 2, 0));
    REFUSED(HOOKE_NO_PARTICLE, 5, hooke_f32_set_mass(scene, 5, 1));
    REFUSED(HOOKE_STIFFNESS, 0, hooke_f32_set_stiffness(scene, 0, NAN));
    REFUSED(HOOKE_NO_SPRING, 4, hooke_f32_set_stiffness(scene, 4, 1));
    REFUSED(HOOKE_REST_LENGTH, 0, hooke_f32_set_rest_length(scene, 0, -1));
    REFUSED(HOOKE_BROKEN, 3, hooke_f32_set_rest_length(scene, 3, 1));
    REFUSED(HOOKE_BROKEN, 3, hooke_f32_break_spring(scene, 3));
    REFUSED(HOOKE_NO_SPRING, SIZE_MAX, hooke_f32_break_spring(scene, SIZE_MAX));
}

static void stepping(void) {
    hooke_f32_report report;
    hooke_f32_motion hand[2] = {{0, {0, 0, 0}, {0, 0, 0}}, {0, {0, 0, 0}, {0, 0, 0}}};
    float fast[3] = {FLT_MAX, 0, 0}, slow[3] = {0, 0, 0};
    SAME(HOOKE_OK, hooke_f32_step_moving(scene, NULL, 0, NULL));
    SAME(HOOKE_OK, hooke_f32_step_moving(scene, hand, 2, &report));
    STEP_REFUSED(HOOKE_NULL, NONE, hooke_f32_step_moving(scene, NULL, 1, &report));
    STEP_REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_step_moving(scene, off(hand), 1, &report));
    STEP_REFUSED(HOOKE_TOO_LARGE, NONE, hooke_f32_step_moving(scene, hand, SIZE_MAX, &report));
    STEP_REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_step_moving(scene, (hooke_f32_motion *)(void *)scene, 1, &report));
    STEP_REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_step(scene, off(&report)));
    STEP_REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_step(scene, (hooke_f32_report *)(void *)scene));
    hand[1].particle = 1;
    STEP_REFUSED(HOOKE_NOT_PINNED, 1, hooke_f32_step_moving(scene, hand, 2, &report));
    hand[1].particle = 5;
    STEP_REFUSED(HOOKE_NOT_PINNED, 5, hooke_f32_step_moving(scene, hand, 2, &report));
    hand[1].particle = 0;
    hand[1].position[2] = NAN; /* a sensor that fails */
    STEP_REFUSED(HOOKE_MOTION, 0, hooke_f32_step_moving(scene, hand, 2, &report));
    hand[1].position[2] = FLT_MAX; /* finite, but its velocity is not */
    STEP_REFUSED(HOOKE_MOTION, 0, hooke_f32_step_moving(scene, hand, 2, &report));
    hand[1].position[2] = 0;
    hand[1].velocity[0] = INFINITY;
    STEP_REFUSED(HOOKE_MOTION, 0, hooke_f32_step_moving(scene, hand, 2, &report));
    SAME(HOOKE_OK, hooke_f32_set_velocity(scene, 4, fast)); /* alone since spring 3 broke */
    SAME(HOOKE_OK, hooke_f32_set_position(scene, 4, fast));
    STEP_REFUSED(HOOKE_NOT_FINITE, 4, hooke_f32_step(scene, &report));
    SAME(HOOKE_OK, hooke_f32_set_velocity(scene, 4, slow));
    SAME(HOOKE_OK, hooke_f32_set_position(scene, 4, slow));
    SAME(HOOKE_OK, hooke_f32_step(scene, &report));
    SAME(2, report.islands); /* {1, 2, 3} on their pin, and 4 */
    SAME(1, report.springs_skipped);
    SAME(1, report.lower <= report.upper);
}

static void reading(void) {
    float x[3], all[PARTICLES][3];
    hooke_f32_energies energies;
    REFUSED(HOOKE_NO_PARTICLE, 5, hooke_f32_position(scene, 5, x));
    REFUSED(HOOKE_NULL, NONE, hooke_f32_velocity(scene, 0, NULL));
    REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_position(scene, 0, (float *)(void *)scene));
    REFUSED(HOOKE_TOO_SMALL, PARTICLES, hooke_f32_positions(scene, all[0], PARTICLES - 1));
    REFUSED(HOOKE_MISALIGNED, NONE, hooke_f32_velocities(scene, off(all), PARTICLES - 1));
    REFUSED(HOOKE_OVERLAP, NONE, hooke_f32_velocities(scene, (float *)(void *)scene, PARTICLES));
    REFUSED(HOOKE_NO_SPRING, 4, hooke_f32_tension(scene, 4, x));
    REFUSED(HOOKE_NO_PARTICLE, 7, hooke_f32_reaction(scene, 7, x));
    REFUSED(HOOKE_NULL, NONE, hooke_f32_energy(scene, NULL));
    REFUSED(HOOKE_NULL, NONE, hooke_f32_particles(scene, NULL));
    SAME(HOOKE_OK, hooke_f32_tension(scene, 3, x));
    SAME(1, x[0] == 0); /* broken */
    SAME(HOOKE_OK, hooke_f32_energy(scene, &energies));
    SAME(1, energies.kinetic > 0 && energies.springs > 0 && energies.gravity < 0);
    SAME(HOOKE_OK, hooke_f32_release(scene, 0));
    SAME(0, strcmp(hooke_message(HOOKE_MOTION), "the motion of a pin is infinite or NaN"));
    SAME(0, strcmp(hooke_message(HOOKE_ACCURACY + 1), "unknown status"));
    SAME(0, strcmp(hooke_message(-1), "unknown status"));
}

int main(void) {
    size = hooke_f32_size(PARTICLES, SPRINGS);
    before = malloc(size);
    elsewhere = malloc(size);
    buffers();
    /* Of exactly the size asked for, so that a memory checker sees any access outside it; and not cleared. */
    SAME(HOOKE_OK, hooke_f32_init(malloc(size), size, PARTICLES, SPRINGS, &scene));
    building();
    options();
    editing();
    stepping();
    reading();
    free(scene);
    free(before);
    free(elsewhere);
    printf("errors: f32, %u checks, %u failures\n", checks, failures);
    return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
