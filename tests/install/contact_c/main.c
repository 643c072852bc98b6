/* Another program's C: the header, the shared library and its creep table, and a geometry table that is not there. */
#include <railtab/contact.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  railtab_contact_parameters parameters;
  railtab_contact* contact;
  char message[400];
  railtab_contact_default_parameters(&parameters);
  parameters.speed = 50.0;
  /* the creep table is read before the geometry table, which is what is missed */
  const railtab_status status =
      railtab_contact_open("no-such-table.h5", NULL, &parameters, &contact, message, sizeof message);
  printf("railtab %s: %s: %s\n", railtab_version(), railtab_status_text(status), message);
  return status == RAILTAB_INVALID_INPUT && contact == NULL && strstr(message, "no-such-table.h5") ? 0 : 1;
}
