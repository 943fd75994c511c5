/* SPDX-License-Identifier: Apache-2.0 */
/* The machine that runs a read expression. */
#include "expression_program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

bool expression_refuse(struct expression_mistake *mistake, size_t position, const char *text)
{
    mistake->position = position;
    mistake->name[0] = '\0';
    (void)snprintf(mistake->text, sizeof mistake->text, "%s", text);
    return false;
}

void expression_destroy(struct expression *expression)
{
    free(expression);
}

void expression_visit(const struct expression *expression, void (*visit)(void *context, int index),
                      void *context)
{
    for (size_t index = 0; index < expression->count; index++) {
        if (expression->program[index].operation == PUSH_NAME)
            visit(context, expression->program[index].name);
    }
}

/* Exact where the result is 0 or 1 by its definition: at multiples of 90 degrees. */
static double sine_of_degrees(double angle)
{
    double turned = remainder(angle, 360.0);
    if (fabs(turned) == 180.0)
        return 0.0;
    return fabs(turned) == 90.0 ? copysign(1.0, turned) : sin(turned * (M_PI / 180.0));
}

static double cosine_of_degrees(double angle)
{
    double turned = fabs(remainder(angle, 360.0));
    return turned == 90.0 ? 0.0 : cos(turned * (M_PI / 180.0));
}

static double apply_one(enum operation operation, double value)
{
    switch (operation) {
    case NEGATE:
        return -value;
    case SQUARE_ROOT:
        return sqrt(value);
    case EXPONENTIAL:
        return exp(value);
    case LOGARITHM:
        return log(value);
    case SINE:
        return sine_of_degrees(value);
    case COSINE:
        return cosine_of_degrees(value);
    default:
        return sine_of_degrees(value) / cosine_of_degrees(value);
    }
}

static double apply_two(enum operation operation, double left, double right)
{
    switch (operation) {
    case ADD:
        return left + right;
    case SUBTRACT:
        return left - right;
    case MULTIPLY:
        return left * right;
    case DIVIDE:
        return left / right;
    case POWER:
        return pow(left, right);
    case MINIMUM:
        return fmin(left, right);
    default:
        return fmax(left, right);
    }
}

static bool takes_two(enum operation operation)
{
    return (operation >= ADD && operation <= POWER) || operation == MINIMUM || operation == MAXIMUM;
}

static const char *failure_text(enum operation operation, double right)
{
    switch (operation) {
    case DIVIDE:
        return right == 0.0 ? "a division by zero" : "the quotient is too large";
    case SQUARE_ROOT:
        return "the square root of a negative number";
    case LOGARITHM:
        return "the logarithm of a number that is not positive";
    case TANGENT:
        return "the tangent of a right angle";
    case POWER:
        return "a power that is no finite number";
    default:
        return "a result that is no finite number";
    }
}

bool expression_evaluate(const struct expression *expression, const double *values, double *result,
                         struct expression_mistake *mistake)
{
    double stack[EXPRESSION_LENGTH_MAX] = {0};
    size_t height = 0;
    for (size_t index = 0; index < expression->count; index++) {
        const struct instruction *instruction = &expression->program[index];
        enum operation operation = instruction->operation;
        double right = height > 0 ? stack[height - 1] : 0.0;
        if (operation == PUSH_NUMBER)
            stack[height++] = instruction->number;
        else if (operation == PUSH_NAME)
            stack[height++] = values[instruction->name];
        else if (takes_two(operation)) {
            height--;
            stack[height - 1] = apply_two(operation, stack[height - 1], right);
        } else
            stack[height - 1] = apply_one(operation, right);
        if (!isfinite(stack[height - 1]))
            return expression_refuse(mistake, instruction->position,
                                     failure_text(operation, right));
    }
    *result = stack[0];
    return true;
}
