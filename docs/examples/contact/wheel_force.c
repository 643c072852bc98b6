/* Forces, derivatives and contact patches of the wheels of a wheelset that has moved aside, by railtab/contact.h.
 *
 *   wheel_force TABLE.h5
 *
 * prints, for each wheel, the nine forces (on the wheelset x, y, z, roll, pitch, yaw; on the rail y, z, roll), their
 * derivatives row by row, and the patches. Numbers have all their digits. */
#include <stdio.h>

#include "railtab/contact.h"

static void print_numbers(const char* name, const double* number, int count) {
  printf("%s", name);
  for (int i = 0; i < count; ++i) printf(" %.16e", number[i]);
  printf("\n");
}

/* Of a wheelset that is 1 mm to the right, turned to the right by 0.5 mrad and moving to the right at 10 mm/s, at the
 * height at which this wheel carries 60 kN. */
static railtab_status print_wheel(const railtab_contact* contact, railtab_side side) {
  railtab_wheelset_motion wheelset = {{0.0, 1e-3, 0.0, 0.0, 0.0, 5e-4}, {0.0, 0.01, 0.0, 0.0, 0.0, 0.0}};
  railtab_wheel_force force;
  railtab_patch patches[RAILTAB_MAX_PATCHES];
  double tangent[81];
  int count = 0;
  const double velocity_rate = 200.0; /* of a time step of 10 ms by the trapezoidal rule: 2/h [1/s] */
  railtab_status status = railtab_contact_height(contact, side, 1e-3, 0.0, 5e-4, 60e3, &wheelset.displacement[2]);
  if (status < 0) return status;
  status = railtab_contact_force_and_tangent(contact, side, &wheelset, NULL, velocity_rate, &force, tangent);
  if (status < 0) return status;
  printf("%s wheel: %s\n", side == RAILTAB_LEFT ? "left" : "right", railtab_status_text(status));
  print_numbers("on the wheelset", force.wheelset, 6);
  print_numbers("on the rail", force.rail, 3);
  for (int i = 0; i < 9; ++i) print_numbers("derivatives", &tangent[9 * i], 9);

  status = railtab_contact_patches(contact, side, &wheelset, NULL, patches, &count);
  if (status < 0) return status;
  for (int i = 0; i < count; ++i) {
    const double patch[] = {patches[i].y_rail,       patches[i].z_rail, patches[i].angle, patches[i].rolling_radius,
                            patches[i].normal_force, patches[i].a,      patches[i].b};
    print_numbers("patch", patch, 7);
  }
  return status;
}

int main(int count, char** argument) {
  if (count != 2) {
    fprintf(stderr, "wheel_force TABLE.h5\n");
    return 2;
  }
  railtab_contact_parameters parameters;
  railtab_contact* contact;
  char message[400];
  railtab_contact_default_parameters(&parameters);
  parameters.speed = 20.0;
  railtab_status status = railtab_contact_open(argument[1], NULL, &parameters, &contact, message, sizeof message);
  if (status != RAILTAB_OK) {
    fprintf(stderr, "wheel_force: %s\n", message);
    return 1;
  }
  status = print_wheel(contact, RAILTAB_LEFT);
  if (status >= 0) status = print_wheel(contact, RAILTAB_RIGHT);
  railtab_contact_close(contact);
  if (status < 0) fprintf(stderr, "wheel_force: %s\n", railtab_status_text(status));
  return status < 0;
}
