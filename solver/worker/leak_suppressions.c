/* SPDX-License-Identifier: Apache-2.0 */
/* Only in builds with the leak sanitizer, which calls these (its documented hooks): fontconfig,
 * which cairo loads for text, keeps its caches until the process ends; and HDF5 what belongs to a
 * file whose last write failed, which must not be closed again (output/hdf5_file.c). */

const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig.so\nleak:libhdf5_serial.so\n";
}

const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}
