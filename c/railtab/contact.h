/* Contact of a wheel and its rail from a table of `tablegen geometry`: forces, their derivatives, contact patches. For
 * multibody programs in C, and in languages that call C. docs/guide/c.md has examples.
 *
 * Units and axes. SI units: m, rad, s, N. x is forward, y to the right, z down. Roll turns y towards z, pitch turns z
 * towards x, yaw turns x towards y. Forces on a wheelset are those of the rail on the wheel, creep forces included.
 *
 * Threads. A function that takes a `const railtab_contact*` may run in any number of threads at once on one contact.
 * Only railtab_contact_open() and railtab_contact_height() allocate memory; no function prints, and none ends the
 * program.
 *
 * Errors. A negative status is an error, and the results of the call are then not written. Nothing is clamped. */
#ifndef RAILTAB_CONTACT_H
#define RAILTAB_CONTACT_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum railtab_status {
  RAILTAB_OK = 0,
  /* A result of the online search: the pose is outside the geometry table, or the wheel is lowered further than the
   * table is trusted. It is as accurate as that of the table, and takes longer. */
  RAILTAB_SEARCHED = 1,
  /* A null pointer, a number out of its range, a file that cannot be read or is no table. */
  RAILTAB_INVALID_INPUT = -1,
  RAILTAB_OUT_OF_MEMORY = -2,
  /* A defect of railtab. */
  RAILTAB_INTERNAL_ERROR = -3
} railtab_status;

/* What a railtab_status means, in English; "unknown status" for other numbers. The text stays valid. */
const char* railtab_status_text(int status);

/* Version of the library, "0.1.0". A program that was built for 0.1 needs a library 0.1. */
const char* railtab_version(void);

/* Numbers of enumerations that a caller passes are int, so that any number is defined, and checked. */
typedef enum railtab_side { RAILTAB_LEFT = 0, RAILTAB_RIGHT = 1 } railtab_side;

typedef enum railtab_creep_law {
  RAILTAB_CREEP_TABLE = 0, /* exact rolling contact from a creep table, Polach outside it */
  RAILTAB_CREEP_POLACH = 1,
  RAILTAB_CREEP_FASTSIM = 2,
  RAILTAB_CREEP_LINEAR = 3 /* Kalker's linear theory, without a friction bound */
} railtab_creep_law;

/* Parameters of the contact forces. railtab_contact_default_parameters() sets all but the speed. */
typedef struct railtab_contact_parameters {
  double speed;           /* running speed V that creepages are relative to [m/s], >= 0 */
  double speed_floor;     /* creepages are relative to at least this [m/s], >= 0; above 0 where the speed can be 0. 0 */
  double friction;        /* coefficient of friction without slip [-], 0..2. 0.3 */
  double friction_limit;  /* coefficient at high slip velocity over `friction`, A of Polach [-], 0..1. 1: constant */
  double friction_decay;  /* fall of friction with the slip velocity, B of Polach [s/m], 0..1e3. 0 */
  double initial_slope;   /* initial slope of creep force over creepage, over that of clean surfaces [-], 1e-3..1. 1 */
  double damping;         /* c of F_n (1 + c d'), d' the rate of penetration [s/m], 0..1e3. 0 */
  double young;           /* Young's modulus of wheel and rail [Pa], > 0. 210e9 */
  double poisson;         /* Poisson's ratio of wheel and rail [-], 0..0.5; a creep table is for one. 0.28 */
  double curvature_floor; /* smallest lateral curvature of the Hertz ellipse [1/m], 1e-6..1e4. 0.05 */
  double k_adhesion;      /* k_A of RAILTAB_CREEP_POLACH [-], 1e-3..1. 1 */
  double k_slip;          /* k_S of RAILTAB_CREEP_POLACH [-], 1e-3..k_A. 1 */
  int creep_law;          /* a railtab_creep_law. RAILTAB_CREEP_TABLE */
} railtab_contact_parameters;

/* Sets the defaults that the comments of the members end with, and the speed to 0, which a caller must change.
 * RAILTAB_INVALID_INPUT where `parameters` is NULL. */
railtab_status railtab_contact_default_parameters(railtab_contact_parameters* parameters);

/* A pair of profiles with its table and the parameters of its forces. */
typedef struct railtab_contact railtab_contact;

/* Reads a geometry table, with the loaded part where the file has one, and a creep table.
 *
 * geometry_table  file of `tablegen geometry`
 * creep_table     file of `tablegen creep`, or NULL for the one that comes with railtab, for Poisson's ratio 0.28; NULL
 *                 with the other creep laws
 * contact         gets the contact, NULL after an error; railtab_contact_close() frees it
 * message         gets what was wrong: file or parameter, what was found, what is allowed. It is cut at message_size
 *                 bytes with the final null, and empty where nothing is wrong; may be NULL. UTF-8
 *
 * RAILTAB_OK, RAILTAB_INVALID_INPUT, RAILTAB_OUT_OF_MEMORY. */
railtab_status railtab_contact_open(const char* geometry_table, const char* creep_table,
                                    const railtab_contact_parameters* parameters, railtab_contact** contact,
                                    char* message, size_t message_size);

/* Frees a contact that no thread uses any more. NULL is allowed. */
void railtab_contact_close(railtab_contact* contact);

/* Changes the running speed [m/s] while no other thread uses the contact. RAILTAB_INVALID_INPUT where the speed is
 * below 0, or 0 without a speed floor. */
railtab_status railtab_contact_set_speed(railtab_contact* contact, double speed);

/* Dimensions of the pair, those of the table [m]. */
typedef struct railtab_dimensions {
  double track_gauge;        /* between the gauge points */
  double gauge_height;       /* depth of the gauge points below the tops of the rail heads */
  double flange_back;        /* between the flange backs */
  double nominal_radius;     /* R0, of the wheel at the tape circle */
  double tape_circle_offset; /* from the wheelset's centre to a tape circle */
  double rail_offset;        /* from the track centre to the top of a rail head */
} railtab_dimensions;

railtab_status railtab_contact_dimensions(const railtab_contact* contact, railtab_dimensions* dimensions);

/* Motion of a wheelset in the track frame, in the order x, y, z, roll, pitch, yaw. */
typedef struct railtab_wheelset_motion {
  /* From the nominal position, centred, R0 above the rail heads [m, rad]. x and pitch do not change forces. */
  double displacement[6];
  /* Beside the running speed [m/s, rad/s]; the pitch rate beside the nominal rotation -V/R0. */
  double velocity[6];
} railtab_wheelset_motion;

/* Motion of the rail head under a wheel, structure and irregularity together, in the track frame. A rail at rest has
 * zeros, and the friction 1; so has NULL in a call. */
typedef struct railtab_rail_motion {
  double displacement[3]; /* y, z [m], roll [rad] */
  double velocity[3];     /* of the rail's material [m/s, rad/s] */
  double yaw;             /* slope dy/dx [-] */
  double slope;           /* slope dz/dx [-] */
  double friction;        /* coefficient of friction there over the parameters' one [-], >= 0 */
} railtab_rail_motion;

/* Forces between a wheel and its rail, in the track frame. */
typedef struct railtab_wheel_force {
  double wheelset[6];      /* on the wheelset: force [N], moment about its centre [N m] (pitch: about its axle) */
  double rail[3];          /* on the rail head: y, z [N], moment about x through the head's top [N m] */
  double rail_x;           /* on the rail, longitudinal [N] */
  int touches;             /* 1 where the wheel touches the rail, else 0, and all forces are 0 */
  int outside_creep_table; /* patches whose creep force came wholly or in part from Polach's law: the creep table does
                            * not reach there; 0 with the other laws */
} railtab_wheel_force;

/* Forces of one wheel, RAILTAB_LEFT or RAILTAB_RIGHT. The rail may be NULL. Status RAILTAB_SEARCHED where the online
 * search answered; RAILTAB_INVALID_INPUT where a pointer is NULL, the side unknown or a number of the motions not
 * finite. */
railtab_status railtab_contact_force(const railtab_contact* contact, int side, const railtab_wheelset_motion* wheelset,
                                     const railtab_rail_motion* rail, railtab_wheel_force* force);

/* The same with the derivatives of the nine forces (wheelset 6, rail 3) with respect to the nine displacements
 * (wheelset 6, rail 3).
 *
 * velocity_rate  dv/dq of a time step, for example gamma/(beta h) of Newmark's method [1/s]; 0 keeps the velocities
 * tangent        [81], row by row: tangent[9 * i + j] is the derivative of force i with respect to displacement j.
 *                In Fortran, tangent(j, i). */
railtab_status railtab_contact_force_and_tangent(const railtab_contact* contact, int side,
                                                 const railtab_wheelset_motion* wheelset,
                                                 const railtab_rail_motion* rail, double velocity_rate,
                                                 railtab_wheel_force* force, double* tangent);

/* Most patches of one wheel. */
#define RAILTAB_MAX_PATCHES 8

/* One contact patch. Coordinates are those of the profiles, the same on both sides: y away from the track centre, z
 * down, on the wheel from its tape circle, on the rail from the top of its head. The loads are without friction and
 * damping. */
typedef struct railtab_patch {
  double y_rail, z_rail;   /* on the rail profile [m] */
  double y_wheel, z_wheel; /* on the wheel profile [m] */
  double x;                /* of the contact point, ahead of the wheelset's centre [m] */
  double angle;            /* contact angle [rad]; negative where the flange touches */
  double rolling_radius;   /* distance of the contact point from the axle [m] */
  double penetration;      /* [m], >= 0 */
  double curvature_wheel;  /* lateral, positive where convex [1/m] */
  double curvature_rail;   /* lateral, positive where convex [1/m] */
  double normal_force;     /* [N] */
  double a, b;             /* semi-axes along and across the rolling direction [m] */
  double pressure;         /* largest [Pa] */
  int concave;             /* 1 where the wheel profile is concave, else 0 */
} railtab_patch;

/* Contact patches of one wheel from the gauge side to the field side. A wheel that just touches has its patch.
 *
 * patches  [RAILTAB_MAX_PATCHES], of which the first *count are written
 * count    0 where the wheel does not touch
 *
 * Status as of railtab_contact_force(). */
railtab_status railtab_contact_patches(const railtab_contact* contact, int side,
                                       const railtab_wheelset_motion* wheelset, const railtab_rail_motion* rail,
                                       railtab_patch* patches, int* count);

/* The vertical displacement z of the wheelset [m] at which the wheel carries a vertical load without friction, on a
 * rail at rest. An iteration, for initial positions.
 *
 * y, roll, yaw  of the wheelset [m], [rad]
 * load          above 0, at most 1e7 [N]
 *
 * RAILTAB_INVALID_INPUT also where wheel and rail never meet, or the wheel does not carry the load 10 mm below first
 * touch. */
railtab_status railtab_contact_height(const railtab_contact* contact, int side, double y, double roll, double yaw,
                                      double load, double* z);

#ifdef __cplusplus
}
#endif

#endif
