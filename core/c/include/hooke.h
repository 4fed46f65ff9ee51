// Hooke for C: 3D mass-spring systems in one buffer of yours. Written by cbindgen; change core/c/src instead.
//
// Everything of a scene lies in its buffer: the library allocates nothing and keeps no pointer and no variable of its
// own between calls. A scene may therefore be moved or copied as bytes, to an equally aligned place: a copy of the
// buffer is a snapshot. To be done with a scene, forget it. Buffers are not portable between machines or versions.
//
// Every call answers a status, HOOKE_OK or what was refused, and then the scene is as it was. All functions come twice:
// hooke_f32_* computes in float, hooke_f64_* in double. Units are metres, kilograms, seconds, newtons, joules.
//
// What is checked: pointers that are null, misaligned, or into the scene's own buffer; a buffer too small; a handle
// whose buffer no scene was made in, one of the other precision, or one whose header was overwritten; every index and
// number; the order of calls. What no library can notice, and you must keep:
//   - a pointer that is neither null nor misaligned points to memory that may be read (and written, if not const) for
//     what the call uses it for: the `bytes` of a buffer, `count` motions, 3 numbers of a vector, a scene's whole buffer;
//   - a buffer is initialised (static, or by calloc) if it is given to any function but hooke_*_init;
//   - one call at a time per scene: a lock, or interrupts off, if several threads or interrupts use one scene. Reading
//     counts as a call. Different scenes do not know of each other;
//   - numbers of a scene that are overwritten behind its back stay unnoticed: the results are then wrong, but no access
//     leaves the buffer.

#ifndef HOOKE_H
#define HOOKE_H

#include <stddef.h>
#include <stdint.h>

// hooke_*_last_index where no particle or spring is concerned.
#define HOOKE_NO_INDEX ((size_t)-1)

// How a call ended. Whatever is not HOOKE_OK has changed nothing in the scene but hooke_*_last_index, which names the
// particle or spring concerned.
enum hooke_status
#ifdef __cplusplus
  : int32_t
#endif // __cplusplus
 {
  // Done.
  HOOKE_OK = 0,
  // A pointer is null.
  HOOKE_NULL = 1,
  // A pointer is not aligned for what it points to; for buffers see hooke_*_alignment.
  HOOKE_MISALIGNED = 2,
  // The buffer or array is too small.
  HOOKE_TOO_SMALL = 3,
  // More particles, springs or motions than fit into memory.
  HOOKE_TOO_LARGE = 4,
  // The handle is no scene: not initialised, of the other precision, or overwritten.
  HOOKE_NOT_A_SCENE = 5,
  // An argument points into the scene's own buffer.
  HOOKE_OVERLAP = 6,
  // hooke_*_set_options has not been called yet.
  HOOKE_NO_OPTIONS = 7,
  // There is no room for another particle; the index is the capacity.
  HOOKE_PARTICLES_FULL = 8,
  // There is no room for another spring; the index is the capacity.
  HOOKE_SPRINGS_FULL = 9,
  // No such particle.
  HOOKE_NO_PARTICLE = 10,
  // No such spring.
  HOOKE_NO_SPRING = 11,
  // A position, velocity or impulse of this particle is, or would become in this step, infinite or NaN.
  HOOKE_NOT_FINITE = 12,
  // The mass of this particle is not a positive finite number.
  HOOKE_MASS = 13,
  // The stiffness of this spring is negative, infinite or NaN.
  HOOKE_STIFFNESS = 14,
  // The rest length of this spring is negative, infinite or NaN.
  HOOKE_REST_LENGTH = 15,
  // Both ends of this spring are the same particle.
  HOOKE_SAME_ENDS = 16,
  // This particle is pinned: it has no velocity of its own.
  HOOKE_PINNED = 17,
  // This particle is not pinned.
  HOOKE_NOT_PINNED = 18,
  // This spring is broken.
  HOOKE_BROKEN = 19,
  // dt is not a positive finite number whose square is one too.
  HOOKE_TIME_STEP = 20,
  // A tolerance is negative, infinite or NaN.
  HOOKE_TOLERANCE = 21,
  // Gravity is infinite or NaN, or drag or damping is that or negative.
  HOOKE_FORCE = 22,
  // The motion of this pin is infinite or NaN, or too far to reach in one step.
  HOOKE_MOTION = 23,
  // dt is beyond the limit of an explicit method, which this particle sets.
  HOOKE_STEP_LIMIT = 24,
  // The equations of the step were not solved; this particle begins the island.
  HOOKE_NOT_CONVERGED = 25,
  // No step is short enough for the accuracy that is asked for.
  HOOKE_ACCURACY = 26,
};
#ifndef __cplusplus
typedef int32_t hooke_status;
#endif // __cplusplus

// A scene in single precision: the front of the caller's buffer.
typedef struct hooke_f32 hooke_f32;

// A scene in double precision: the front of the caller's buffer.
typedef struct hooke_f64 hooke_f64;

// How a scene is stepped. Begin with hooke_*_defaults.
typedef struct hooke_f64_options {
  // Time step, s; positive.
  double dt;
  // Gravity, m/s^2.
  double gravity[3];
  // Drag rate d >= 0, 1/s: each particle feels -d m v.
  double drag;
  // Damping along every spring, N s/m; >= 0.
  double damping;
  // Relative tolerance of the solve.
  double tolerance;
  // Absolute tolerance of the solve, J: it also stops where the error's energy is at most this.
  double absolute;
  // At most so many iterations per island and step; the report tells the bound reached.
  uint32_t max_iterations;
} hooke_f64_options;


// What a step says of itself: sums over the islands, the parts of a scene that are solved apart.
typedef struct hooke_f64_report {
  // The energy of the solve's error, J, is at most this.
  double upper;
  // It is at least this.
  double lower;
  // Iterations of all islands together.
  uint32_t iterations;
  // Springs whose Hessian was clamped or replaced.
  uint32_t clamped;
  // Number of islands.
  uint32_t islands;
  // Islands that met the tolerance at 0 iterations.
  uint32_t untouched;
  // Islands certified without a projection pass.
  uint32_t certified;
  // Islands that ended at the floor of their own rounding: no better answer can be recognised.
  uint32_t at_floor;
  // Islands that used up max_iterations.
  uint32_t capped;
  // Islands that stalled above the floor.
  uint32_t stalled;
  // Springs that no island needed: broken, or with both ends pinned.
  uint32_t springs_skipped;
} hooke_f64_report;


// Where a pinned particle is, and how fast it moves, at the end of a step.
typedef struct hooke_f64_motion {
  // Which particle; it must be pinned.
  size_t particle;
  // Where it is then, m.
  double position[3];
  // How fast it moves then, m/s.
  double velocity[3];
} hooke_f64_motion;


// Energies, J.
typedef struct hooke_f64_energies {
  // Kinetic energy.
  double kinetic;
  // Potential energy of the springs.
  double springs;
  // Potential energy in gravity; 0 at the origin.
  double gravity;
} hooke_f64_energies;


// How a scene is stepped. Begin with hooke_*_defaults.
typedef struct hooke_f32_options {
  // Time step, s; positive.
  float dt;
  // Gravity, m/s^2.
  float gravity[3];
  // Drag rate d >= 0, 1/s: each particle feels -d m v.
  float drag;
  // Damping along every spring, N s/m; >= 0.
  float damping;
  // Relative tolerance of the solve.
  float tolerance;
  // Absolute tolerance of the solve, J: it also stops where the error's energy is at most this.
  float absolute;
  // At most so many iterations per island and step; the report tells the bound reached.
  uint32_t max_iterations;
} hooke_f32_options;


// What a step says of itself: sums over the islands, the parts of a scene that are solved apart.
typedef struct hooke_f32_report {
  // The energy of the solve's error, J, is at most this.
  float upper;
  // It is at least this.
  float lower;
  // Iterations of all islands together.
  uint32_t iterations;
  // Springs whose Hessian was clamped or replaced.
  uint32_t clamped;
  // Number of islands.
  uint32_t islands;
  // Islands that met the tolerance at 0 iterations.
  uint32_t untouched;
  // Islands certified without a projection pass.
  uint32_t certified;
  // Islands that ended at the floor of their own rounding: no better answer can be recognised.
  uint32_t at_floor;
  // Islands that used up max_iterations.
  uint32_t capped;
  // Islands that stalled above the floor.
  uint32_t stalled;
  // Springs that no island needed: broken, or with both ends pinned.
  uint32_t springs_skipped;
} hooke_f32_report;


// Where a pinned particle is, and how fast it moves, at the end of a step.
typedef struct hooke_f32_motion {
  // Which particle; it must be pinned.
  size_t particle;
  // Where it is then, m.
  float position[3];
  // How fast it moves then, m/s.
  float velocity[3];
} hooke_f32_motion;


// Energies, J.
typedef struct hooke_f32_energies {
  // Kinetic energy.
  float kinetic;
  // Potential energy of the springs.
  float springs;
  // Potential energy in gravity; 0 at the origin.
  float gravity;
} hooke_f32_energies;


#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Bytes that a buffer for up to so many particles and springs must have; 0 if no memory has so many.
size_t hooke_f64_size(size_t particles, size_t springs);

// What the address of a buffer must be a multiple of.
size_t hooke_f64_alignment(void);

// Makes an empty scene for up to so many particles and springs in a buffer of so many bytes, whatever it held before.
// The handle that goes to *scene is the buffer's own address. On an error nothing is written, to *scene neither.
hooke_status hooke_f64_init(void *buffer,
                            size_t bytes,
                            size_t particles,
                            size_t springs,
                            struct hooke_f64 **scene);

// The values that hold for a program that says nothing: no forces, the kernel's tolerance. dt is left 0, to be given.
hooke_status hooke_f64_defaults(hooke_f64_options *options);

// Sets how the scene is stepped; refused as a whole if a value is no good. Before the first step.
hooke_status hooke_f64_set_options(struct hooke_f64 *scene, const hooke_f64_options *options);

// Adds a free particle at rest at position[3], m, with mass, kg. Its index, counted from 0, goes to *index if that is
// not null.
hooke_status hooke_f64_add_particle(struct hooke_f64 *scene,
                                    const double *position,
                                    double mass,
                                    size_t *index);

// Joins two particles by a spring of stiffness, N/m, whose rest length is their present distance. Its index goes to *index
// if that is not null.
hooke_status hooke_f64_add_spring(struct hooke_f64 *scene,
                                  size_t a,
                                  size_t b,
                                  double stiffness,
                                  size_t *index);

// As hooke_f64_add_spring with a given rest length, m.
hooke_status hooke_f64_add_spring_with(struct hooke_f64 *scene,
                                       size_t a,
                                       size_t b,
                                       double stiffness,
                                       double rest_length,
                                       size_t *index);

// Pins a particle where it is: it rests unless a step is told its motion.
hooke_status hooke_f64_pin(struct hooke_f64 *scene, size_t particle);

// Releases a pinned particle; it goes on with the velocity it had as a pin.
hooke_status hooke_f64_release(struct hooke_f64 *scene, size_t particle);

// Puts a particle, pinned or free, at position[3], m, at once.
hooke_status hooke_f64_set_position(struct hooke_f64 *scene, size_t particle, const double *position);

// Sets the velocity[3], m/s, of a free particle.
hooke_status hooke_f64_set_velocity(struct hooke_f64 *scene, size_t particle, const double *velocity);

// Gives a free particle an impulse[3], N s.
hooke_status hooke_f64_impulse(struct hooke_f64 *scene, size_t particle, const double *impulse);

// Changes the mass of a particle, kg. Its velocity stays.
hooke_status hooke_f64_set_mass(struct hooke_f64 *scene, size_t particle, double mass);

// Changes the stiffness of a spring, N/m.
hooke_status hooke_f64_set_stiffness(struct hooke_f64 *scene, size_t spring, double stiffness);

// Changes the rest length of a spring, m.
hooke_status hooke_f64_set_rest_length(struct hooke_f64 *scene, size_t spring, double rest_length);

// Breaks a spring for good. The indices of the others stay.
hooke_status hooke_f64_break_spring(struct hooke_f64 *scene, size_t spring);

// Advances by one time step; pins rest. What the step says of itself goes to *report if that is not null.
hooke_status hooke_f64_step(struct hooke_f64 *scene, hooke_f64_report *report);

// As hooke_f64_step while some pins move. Of two motions of one particle the later counts.
hooke_status hooke_f64_step_moving(struct hooke_f64 *scene,
                                   const hooke_f64_motion *motions,
                                   size_t count,
                                   hooke_f64_report *report);

// How many particles there are.
hooke_status hooke_f64_particles(struct hooke_f64 *scene, size_t *count);

// How many springs there are, broken ones included.
hooke_status hooke_f64_springs(struct hooke_f64 *scene, size_t *count);

// Where a particle is, m, to position[3].
hooke_status hooke_f64_position(struct hooke_f64 *scene, size_t particle, double *position);

// How fast a particle is, m/s, to velocity[3].
hooke_status hooke_f64_velocity(struct hooke_f64 *scene, size_t particle, double *velocity);

// All positions, m, as x, y, z of particle 0, then of particle 1, ..., to an array with room for so many particles.
hooke_status hooke_f64_positions(struct hooke_f64 *scene,
                                 double *array,
                                 size_t particles);

// As hooke_f64_positions for the velocities, m/s.
hooke_status hooke_f64_velocities(struct hooke_f64 *scene, double *array, size_t particles);

// The tension of a spring, N, to *tension: positive pulls; 0 for a broken one.
hooke_status hooke_f64_tension(struct hooke_f64 *scene, size_t spring, double *tension);

// The force that would hold a particle at rest in the present state, N, to force[3]: at a pin, what its support carries.
// Takes time proportional to the number of springs.
hooke_status hooke_f64_reaction(struct hooke_f64 *scene,
                                size_t particle,
                                double *force);

// The energies of the present state, J; that in gravity is 0 until options are set.
hooke_status hooke_f64_energy(struct hooke_f64 *scene, hooke_f64_energies *energies);

// The particle or spring that the last failed call on this scene was about, HOOKE_NO_INDEX if none.
size_t hooke_f64_last_index(struct hooke_f64 *scene);

// Bytes that a buffer for up to so many particles and springs must have; 0 if no memory has so many.
size_t hooke_f32_size(size_t particles, size_t springs);

// What the address of a buffer must be a multiple of.
size_t hooke_f32_alignment(void);

// Makes an empty scene for up to so many particles and springs in a buffer of so many bytes, whatever it held before.
// The handle that goes to *scene is the buffer's own address. On an error nothing is written, to *scene neither.
hooke_status hooke_f32_init(void *buffer,
                            size_t bytes,
                            size_t particles,
                            size_t springs,
                            struct hooke_f32 **scene);

// The values that hold for a program that says nothing: no forces, the kernel's tolerance. dt is left 0, to be given.
hooke_status hooke_f32_defaults(hooke_f32_options *options);

// Sets how the scene is stepped; refused as a whole if a value is no good. Before the first step.
hooke_status hooke_f32_set_options(struct hooke_f32 *scene, const hooke_f32_options *options);

// Adds a free particle at rest at position[3], m, with mass, kg. Its index, counted from 0, goes to *index if that is
// not null.
hooke_status hooke_f32_add_particle(struct hooke_f32 *scene,
                                    const float *position,
                                    float mass,
                                    size_t *index);

// Joins two particles by a spring of stiffness, N/m, whose rest length is their present distance. Its index goes to *index
// if that is not null.
hooke_status hooke_f32_add_spring(struct hooke_f32 *scene,
                                  size_t a,
                                  size_t b,
                                  float stiffness,
                                  size_t *index);

// As hooke_f32_add_spring with a given rest length, m.
hooke_status hooke_f32_add_spring_with(struct hooke_f32 *scene,
                                       size_t a,
                                       size_t b,
                                       float stiffness,
                                       float rest_length,
                                       size_t *index);

// Pins a particle where it is: it rests unless a step is told its motion.
hooke_status hooke_f32_pin(struct hooke_f32 *scene, size_t particle);

// Releases a pinned particle; it goes on with the velocity it had as a pin.
hooke_status hooke_f32_release(struct hooke_f32 *scene, size_t particle);

// Puts a particle, pinned or free, at position[3], m, at once.
hooke_status hooke_f32_set_position(struct hooke_f32 *scene, size_t particle, const float *position);

// Sets the velocity[3], m/s, of a free particle.
hooke_status hooke_f32_set_velocity(struct hooke_f32 *scene, size_t particle, const float *velocity);

// Gives a free particle an impulse[3], N s.
hooke_status hooke_f32_impulse(struct hooke_f32 *scene, size_t particle, const float *impulse);

// Changes the mass of a particle, kg. Its velocity stays.
hooke_status hooke_f32_set_mass(struct hooke_f32 *scene, size_t particle, float mass);

// Changes the stiffness of a spring, N/m.
hooke_status hooke_f32_set_stiffness(struct hooke_f32 *scene, size_t spring, float stiffness);

// Changes the rest length of a spring, m.
hooke_status hooke_f32_set_rest_length(struct hooke_f32 *scene, size_t spring, float rest_length);

// Breaks a spring for good. The indices of the others stay.
hooke_status hooke_f32_break_spring(struct hooke_f32 *scene, size_t spring);

// Advances by one time step; pins rest. What the step says of itself goes to *report if that is not null.
hooke_status hooke_f32_step(struct hooke_f32 *scene, hooke_f32_report *report);

// As hooke_f32_step while some pins move. Of two motions of one particle the later counts.
hooke_status hooke_f32_step_moving(struct hooke_f32 *scene,
                                   const hooke_f32_motion *motions,
                                   size_t count,
                                   hooke_f32_report *report);

// How many particles there are.
hooke_status hooke_f32_particles(struct hooke_f32 *scene, size_t *count);

// How many springs there are, broken ones included.
hooke_status hooke_f32_springs(struct hooke_f32 *scene, size_t *count);

// Where a particle is, m, to position[3].
hooke_status hooke_f32_position(struct hooke_f32 *scene, size_t particle, float *position);

// How fast a particle is, m/s, to velocity[3].
hooke_status hooke_f32_velocity(struct hooke_f32 *scene, size_t particle, float *velocity);

// All positions, m, as x, y, z of particle 0, then of particle 1, ..., to an array with room for so many particles.
hooke_status hooke_f32_positions(struct hooke_f32 *scene,
                                 float *array,
                                 size_t particles);

// As hooke_f32_positions for the velocities, m/s.
hooke_status hooke_f32_velocities(struct hooke_f32 *scene, float *array, size_t particles);

// The tension of a spring, N, to *tension: positive pulls; 0 for a broken one.
hooke_status hooke_f32_tension(struct hooke_f32 *scene, size_t spring, float *tension);

// The force that would hold a particle at rest in the present state, N, to force[3]: at a pin, what its support carries.
// Takes time proportional to the number of springs.
hooke_status hooke_f32_reaction(struct hooke_f32 *scene,
                                size_t particle,
                                float *force);

// The energies of the present state, J; that in gravity is 0 until options are set.
hooke_status hooke_f32_energy(struct hooke_f32 *scene, hooke_f32_energies *energies);

// The particle or spring that the last failed call on this scene was about, HOOKE_NO_INDEX if none.
size_t hooke_f32_last_index(struct hooke_f32 *scene);

// A status in words, a constant string. A number that is no status gives "unknown status".
const char *hooke_message(int32_t status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HOOKE_H */
