/* SPDX-License-Identifier: Apache-2.0 */
/* Expressions: values, precedence, and every kind of mistake with its position. */
#include "expression.h"
#include "server_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int find(void *context, const char *name, size_t length)
{
    static const char *const names[] = {"a", "height", "b_2", NULL};
    (void)context;
    for (int index = 0; names[index] != NULL; index++) {
        if (strlen(names[index]) == length && strncmp(names[index], name, length) == 0)
            return index;
    }
    return -1;
}

static const double values[] = {2.0, 0.1, -3.0};

static void test_values(void **state)
{
    static const struct {
        const char *text;
        double value;
    } cases[] = {
        {"1", 1.0},
        {" 2.5e-1 ", 0.25},
        {".5", 0.5},
        {"5.", 5.0},
        {"1E3", 1000.0},
        {"1 + 2 * 3", 7.0},
        {"(1 + 2) * 3", 9.0},
        {"8 / 4 / 2", 1.0},
        {"8 - 4 - 2", 2.0},
        {"8 - (4 - 2)", 6.0},
        {"-2 ^ 2", -4.0},
        {"(-2) ^ 2", 4.0},
        {"2 ^ 3 ^ 2", 512.0},
        {"2 ^ -1", 0.5},
        {"2 * -3", -6.0},
        {"--2", 2.0},
        {"2 - -3", 5.0},
        {"a * height", 0.2},
        {"-b_2", 3.0},
        {"a\t*\n a", 4.0},
        {"min(3, 1, 2)", 1.0},
        {"max(3, 1, a ^ 3)", 8.0},
        {"min(7)", 7.0},
        {"max(min(1, 2), 0) + 1", 2.0},
        {"sqrt(16)", 4.0},
        {"exp(0)", 1.0},
        {"log(exp(2))", 2.0},
        {"sin(30)", 0.5},
        {"sin(180)", 0.0},
        {"sin(-450)", -1.0},
        {"cos(90)", 0.0},
        {"cos(270)", 0.0},
        {"cos(60)", 0.5},
        {"cos(180)", -1.0},
        {"tan(45)", 1.0},
        {"tan(-60)", -1.7320508075688772},
        {"pi", 3.141592653589793},
        {"2*pi*a", 12.566370614359172},
        {"0 ^ 0", 1.0},
    };
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        struct expression_mistake mistake;
        double value = NAN;
        struct expression *expression = expression_create(cases[index].text, find, NULL, &mistake);
        if (expression == NULL || !expression_evaluate(expression, values, &value, &mistake) ||
            !(fabs(value - cases[index].value) <= 1e-15 * fmax(1.0, fabs(cases[index].value))))
            fail_msg("%s: %.17g", cases[index].text, value);
        expression_destroy(expression);
    }
}

static void test_mistakes(void **state)
{
    static const struct {
        const char *text;
        size_t position;
        const char *name;
    } cases[] = {
        {"", 0, ""},
        {"  ", 2, ""},
        {"1 +", 3, ""},
        {"1 2", 2, ""},
        {"2a", 1, ""},
        {"(1", 2, ""},
        {"1)", 1, ""},
        {"()", 1, ""},
        {"* 2", 0, ""},
        {"+2", 0, ""},
        {"1 ++ 2", 3, ""},
        {"a $ b", 2, ""},
        {"heigth", 0, "heigth"},
        {"1 + Pi", 4, "Pi"},
        {"sin 30", 4, ""},
        {"sin", 3, ""},
        {"sin(1, 2)", 5, ""},
        {"min()", 4, ""},
        {"min(1,)", 6, ""},
        {"foo(1)", 0, "foo"},
        {".", 0, ""},
        {"1..2", 2, ""},
        {"1e999", 0, ""},
        {"0x10", 1, ""},
        {"2e", 1, ""},
        {"2e+", 1, ""},
        {"inf", 0, "inf"},
        {"nan", 0, "nan"},
        {"a = 1", 2, ""},
        {"a^", 2, ""},
        {"1,2", 1, ""},
        {"\"a\"", 0, ""},
        {"a**2", 2, ""},
        {"1_000", 1, ""},
    };
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        struct expression_mistake mistake = {.position = 99};
        struct expression *expression = expression_create(cases[index].text, find, NULL, &mistake);
        if (expression != NULL || mistake.position != cases[index].position ||
            strcmp(mistake.name, cases[index].name) != 0 || mistake.text[0] == '\0')
            fail_msg("'%s': %zu '%s' %s", cases[index].text, mistake.position, mistake.name,
                     mistake.text);
    }
}

static void test_not_finite(void **state)
{
    static const struct {
        const char *text;
        size_t position;
        const char *why;
    } cases[] = {
        {"1 / (a - 2)", 2, "division by zero"},
        {"0 / 0", 2, "division by zero"},
        {"sqrt(b_2)", 0, "square root"},
        {"log(0)", 0, "logarithm"},
        {"1 + log(-1)", 4, "logarithm"},
        {"tan(90)", 0, "right angle"},
        {"tan(-270)", 0, "right angle"},
        {"exp(1000)", 0, "finite"},
        {"10 ^ 400", 3, "power"},
        {"(-8) ^ 0.5", 5, "power"},
        {"0 ^ -1", 2, "power"},
        {"1e308 * 10", 6, "finite"},
    };
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        struct expression_mistake mistake;
        double value;
        struct expression *expression = expression_create(cases[index].text, find, NULL, &mistake);
        assert_non_null(expression);
        if (expression_evaluate(expression, values, &value, &mistake) ||
            mistake.position != cases[index].position ||
            strstr(mistake.text, cases[index].why) == NULL)
            fail_msg("%s: %zu %s", cases[index].text, mistake.position, mistake.text);
        expression_destroy(expression);
    }
}

static void test_limits(void **state)
{
    struct expression_mistake mistake;
    char text[EXPRESSION_LENGTH_MAX + 2];
    static const char *const endless[] = {"(", "-", "1^", "min(", "1+("};
    (void)state;
    memset(text, '1', sizeof text); /* too long */
    text[sizeof text - 1] = '\0';
    assert_null(expression_create(text, find, NULL, &mistake));
    for (size_t index = 0; index < sizeof endless / sizeof endless[0]; index++) {
        size_t length = strlen(endless[index]);
        for (size_t byte = 0; byte < EXPRESSION_LENGTH_MAX; byte++)
            text[byte] = endless[index][byte % length];
        text[EXPRESSION_LENGTH_MAX] = '\0';
        assert_null(expression_create(text, find, NULL, &mistake));
        assert_non_null(strstr(mistake.text, "deep"));
    }
    for (size_t byte = 0; byte < EXPRESSION_LENGTH_MAX; byte++) /* as many operations as bytes */
        text[byte] = byte % 2 == 0 ? '1' : '+';
    text[EXPRESSION_LENGTH_MAX - 1] = '\0';
    struct expression *expression = expression_create(text, find, NULL, &mistake);
    double value = 0.0;
    assert_non_null(expression);
    assert_true(expression_evaluate(expression, values, &value, &mistake));
    assert_true(value == 0.5 * EXPRESSION_LENGTH_MAX);
    expression_destroy(expression);
}

/* What is no expression is refused; what is one has one value; neither reads beyond its text. */
static void test_mutations(void **state)
{
    static const char *const seeds[] = {"min(a, 2.5e-3) * -(height + 1) ^ 2 / pi",
                                        "sin(30) + cos(a*b_2) - tan(0.1) * max(1, 2, 3)",
                                        "sqrt(exp(log(a)))"};
    static const char alphabet[] = "0123456789.eE+-*/^(), abminsqrtxp_\t\x80\xff$\"";
    unsigned int random = 1;
    size_t good = 0;
    (void)state;
    for (int trial = 0; trial < 20000; trial++) {
        struct expression_mistake mistake;
        double value;
        size_t length = strlen(seeds[trial % 3]);
        char *text = malloc(length + 1);
        assert_non_null(text);
        memcpy(text, seeds[trial % 3], length + 1);
        for (int change = 0; change < 1 + trial % 4; change++) {
            random = random * 1664525U + 1013904223U;
            text[(random >> 8) % length] = alphabet[(random >> 20) % (sizeof alphabet - 1)];
        }
        struct expression *expression = expression_create(text, find, NULL, &mistake);
        if (expression == NULL) {
            assert_true(mistake.position <= length);
        } else if (expression_evaluate(expression, values, &value, &mistake)) {
            assert_true(isfinite(value));
            good++;
        }
        expression_destroy(expression);
        free(text);
    }
    assert_in_range(good, 100, 10000);
}

static void test_names(void **state)
{
    (void)state;
    assert_true(expression_name_is_valid("a"));
    assert_true(expression_name_is_valid("_k0"));
    assert_true(expression_name_is_valid("\xcf\x86"));
    assert_true(expression_name_is_valid("sine"));
    assert_false(expression_name_is_valid(""));
    assert_false(expression_name_is_valid("0a"));
    assert_false(expression_name_is_valid("a b"));
    assert_false(expression_name_is_valid("a-b"));
    assert_false(expression_name_is_valid("pi"));
    assert_false(expression_name_is_valid("min"));
}

static void use_count(void *context, int index)
{
    ((int *)context)[index]++;
}

static void test_visit(void **state)
{
    struct expression_mistake mistake;
    int uses[3] = {0};
    (void)state;
    struct expression *expression = expression_create("a + b_2 * a", find, NULL, &mistake);
    assert_non_null(expression);
    expression_visit(expression, use_count, uses);
    assert_int_equal(uses[0], 2);
    assert_int_equal(uses[1], 0);
    assert_int_equal(uses[2], 1);
    expression_destroy(expression);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),     cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_not_finite), cmocka_unit_test(test_limits),
        cmocka_unit_test(test_mutations),  cmocka_unit_test(test_names),
        cmocka_unit_test(test_visit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
