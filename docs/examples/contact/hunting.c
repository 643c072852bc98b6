/* A free wheelset on straight track, with forces by railtab/contact.h. Its wheels steer it to and fro about the track
 * centre: at low speed on the sinusoid of Klingel, at higher speed further and further aside, up to the flanges
 * (hunting).
 *
 *   hunting TABLE.h5 [SPEED_IN_M_S [DISTANCE_IN_M]]
 *
 * prints, at each passage of the track centre, the wavelength and the amplitude of the last half-wave. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "railtab/contact.h"

enum { X, Y, Z, ROLL, PITCH, YAW };

/* mass [kg] and moments of inertia [kg m2] of the wheelset; the weight that its wheels carry [N] */
static const double inertia[6] = {1500.0, 1500.0, 1500.0, 900.0, 100.0, 900.0};
static const double weight = 120e3;
static const double step = 1e-4; /* [s] */

/* One explicit step: velocities from the forces, displacements from the new velocities. */
static int advance(const railtab_contact* contact, railtab_wheelset_motion* wheelset) {
  railtab_wheel_force left, right;
  railtab_status status = railtab_contact_force(contact, RAILTAB_LEFT, wheelset, NULL, &left);
  if (status >= 0) status = railtab_contact_force(contact, RAILTAB_RIGHT, wheelset, NULL, &right);
  if (status < 0) {
    fprintf(stderr, "hunting: %s\n", railtab_status_text(status));
    return 0;
  }
  for (int i = Y; i <= YAW; ++i) { /* the speed along x stays */
    const double force = left.wheelset[i] + right.wheelset[i] + (i == Z ? weight : 0.0);
    wheelset->velocity[i] += step * force / inertia[i];
    wheelset->displacement[i] += step * wheelset->velocity[i];
  }
  return 1;
}

/* Rolls over a distance and prints where the wheelset went. */
static int roll(const railtab_contact* contact, double speed, double distance) {
  const double yaw = 1e-3; /* it starts at the centre, obliquely */
  railtab_wheelset_motion wheelset = {{0.0, 0.0, 0.0, 0.0, 0.0, yaw}, {0.0, speed * yaw, 0.0, 0.0, 0.0, 0.0}};
  if (railtab_contact_height(contact, RAILTAB_RIGHT, 0.0, 0.0, yaw, weight / 2, &wheelset.displacement[Z]) < 0)
    return 0;

  double farthest = 0.0, passage = 0.0;
  int passages = 0;
  for (double x = 0.0; x < distance; x += step * speed) {
    const double before = wheelset.displacement[Y];
    if (!advance(contact, &wheelset)) return 0;
    const double after = wheelset.displacement[Y];
    farthest = fmax(farthest, fabs(after));
    if (before * after < 0.0) { /* between two steps it passes the track centre */
      const double here = x + step * speed * before / (before - after);
      if (++passages > 1) printf("wavelength %.4f m, amplitude %.4f mm\n", 2.0 * (here - passage), 1e3 * farthest);
      passage = here;
      farthest = 0.0;
    }
  }
  return 1;
}

int main(int count, char** argument) {
  if (count < 2) {
    fprintf(stderr, "hunting TABLE.h5 [SPEED_IN_M_S [DISTANCE_IN_M]]\n");
    return 2;
  }
  railtab_contact_parameters parameters;
  railtab_contact* contact;
  char message[400];
  railtab_contact_default_parameters(&parameters);
  parameters.speed = count > 2 ? atof(argument[2]) : 10.0;
  if (railtab_contact_open(argument[1], NULL, &parameters, &contact, message, sizeof message) != RAILTAB_OK) {
    fprintf(stderr, "hunting: %s\n", message);
    return 1;
  }
  const int rolled = roll(contact, parameters.speed, count > 3 ? atof(argument[3]) : 50.0);
  railtab_contact_close(contact);
  return rolled ? 0 : 1;
}
