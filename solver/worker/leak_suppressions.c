/* SPDX-License-Identifier: Apache-2.0 */
/* Only in builds with the leak sanitizer, which calls these (its documented hooks): fontconfig,
 * which cairo loads for text, keeps its caches until the process ends. */

const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig.so\n";
}

const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}
