/* Files that stand in vsi and go into every FMU. */
#ifndef RAILTAB_EMBEDDED_H
#define RAILTAB_EMBEDDED_H

#ifdef __cplusplus
extern "C" {
#endif

/* the library of the FMU, from begin to end */
extern const char railtab_fmu_library_begin[], railtab_fmu_library_end[];
/* railtab's licence */
extern const char railtab_license_begin[], railtab_license_end[];

#ifdef __cplusplus
}
#endif

#endif
