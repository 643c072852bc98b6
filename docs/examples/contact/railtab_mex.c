/* railtab/contact.h for Octave, as a MEX function that keeps one contact:
 *
 *   railtab_mex("open", file, speed)                     reads a geometry table; speed in m/s
 *   z = railtab_mex("height", side, y, roll, yaw, load)  height at which the wheel carries the load
 *   [force, tangent] = railtab_mex("force", side, displacement, velocity, velocity_rate)
 *   patches = railtab_mex("patches", side, displacement)
 *   railtab_mex("close")
 *
 * side is "left" or "right", displacement and velocity have 6 numbers, force has 9, tangent (9, 9); a row of patches is
 * y_rail, z_rail, angle, rolling_radius, normal_force, a, b. Units and signs are those of the header; the rail rests.
 */
#include <mex.h>
#include <string.h>

#include "railtab/contact.h"

static railtab_contact* contact = NULL;

static void close_contact(void) {
  railtab_contact_close(contact);
  contact = NULL;
}

static void require(int holds, const char* expected) {
  if (!holds) mexErrMsgIdAndTxt("railtab:input", "railtab_mex: expected %s", expected);
}

static void require_success(railtab_status status) {
  if (status < 0) mexErrMsgIdAndTxt("railtab:status", "railtab_mex: %s", railtab_status_text(status));
}

static const double* numbers(const mxArray* array, size_t count) {
  require(mxIsDouble(array) && !mxIsComplex(array) && mxGetNumberOfElements(array) == count,
          "6 real numbers of a motion");
  return mxGetPr(array);
}

static int is(const mxArray* array, const char* word) {
  char text[16];
  return mxIsChar(array) && mxGetString(array, text, sizeof text) == 0 && strcmp(text, word) == 0;
}

static railtab_side side_of(const mxArray* array) {
  require(is(array, "left") || is(array, "right"), "\"left\" or \"right\"");
  return is(array, "left") ? RAILTAB_LEFT : RAILTAB_RIGHT;
}

static void open_contact(const mxArray* file, double speed) {
  railtab_contact_parameters parameters;
  char message[400], name[1024];
  require(mxIsChar(file) && mxGetString(file, name, sizeof name) == 0, "the name of a file");
  railtab_contact_default_parameters(&parameters);
  parameters.speed = speed;
  close_contact();
  if (railtab_contact_open(name, NULL, &parameters, &contact, message, sizeof message) < 0) {
    mexErrMsgIdAndTxt("railtab:open", "%s", message);
  }
  mexAtExit(close_contact);
}

static void put_force(mxArray** result, railtab_side side, const railtab_wheelset_motion* wheelset, double rate) {
  railtab_wheel_force force;
  double rows[81];
  require_success(railtab_contact_force_and_tangent(contact, side, wheelset, NULL, rate, &force, rows));
  result[0] = mxCreateDoubleMatrix(9, 1, mxREAL);
  result[1] = mxCreateDoubleMatrix(9, 9, mxREAL);
  memcpy(mxGetPr(result[0]), force.wheelset, sizeof force.wheelset);
  memcpy(mxGetPr(result[0]) + 6, force.rail, sizeof force.rail);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) mxGetPr(result[1])[i + 9 * j] = rows[9 * i + j]; /* columns stand together in Octave */
  }
}

static void put_patches(mxArray** result, railtab_side side, const railtab_wheelset_motion* wheelset) {
  railtab_patch patches[RAILTAB_MAX_PATCHES];
  int count;
  require_success(railtab_contact_patches(contact, side, wheelset, NULL, patches, &count));
  *result = mxCreateDoubleMatrix((mwSize)count, 7, mxREAL);
  for (int i = 0; i < count; ++i) {
    const railtab_patch* const p = &patches[i];
    const double row[7] = {p->y_rail, p->z_rail, p->angle, p->rolling_radius, p->normal_force, p->a, p->b};
    for (int j = 0; j < 7; ++j) mxGetPr(*result)[i + count * j] = row[j];
  }
}

void mexFunction(int results, mxArray* result[], int arguments, const mxArray* argument[]) {
  mxArray* both[2];
  railtab_wheelset_motion wheelset = {{0.0}, {0.0}};
  require(arguments > 0, "\"open\", \"height\", \"force\", \"patches\" or \"close\"");
  if (is(argument[0], "open") && arguments == 3) {
    open_contact(argument[1], mxGetScalar(argument[2]));
    return;
  }
  if (is(argument[0], "close")) {
    close_contact();
    return;
  }
  require(contact != NULL, "\"open\" first");
  if (is(argument[0], "height") && arguments == 6) {
    double z = 0.0;
    require_success(railtab_contact_height(contact, side_of(argument[1]), mxGetScalar(argument[2]),
                                           mxGetScalar(argument[3]), mxGetScalar(argument[4]), mxGetScalar(argument[5]),
                                           &z));
    result[0] = mxCreateDoubleScalar(z);
  } else if (is(argument[0], "force") && arguments == 5) {
    memcpy(wheelset.displacement, numbers(argument[2], 6), sizeof wheelset.displacement);
    memcpy(wheelset.velocity, numbers(argument[3], 6), sizeof wheelset.velocity);
    put_force(both, side_of(argument[1]), &wheelset, mxGetScalar(argument[4]));
    result[0] = both[0];
    if (results > 1) result[1] = both[1];
  } else if (is(argument[0], "patches") && arguments == 3) {
    memcpy(wheelset.displacement, numbers(argument[2], 6), sizeof wheelset.displacement);
    put_patches(result, side_of(argument[1]), &wheelset);
  } else {
    require(0, "one of the calls that the head of railtab_mex.c lists");
  }
}
