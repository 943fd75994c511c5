/* SPDX-License-Identifier: Apache-2.0 */
/* A parser by recursive descent that writes a program in postfix order. */
#include "expression_program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 100, NUMBER_LENGTH_MAX = 63 };

struct parser {
    const char *text;
    size_t position;
    int depth;
    expression_find *find;
    void *context;
    struct expression *expression;
    struct expression_mistake *mistake;
};

static const struct function {
    const char *name;
    enum operation operation;
    bool many; /* takes one argument or more */
} functions[] = {
    {"min", MINIMUM, true},      {"max", MAXIMUM, true},    {"sqrt", SQUARE_ROOT, false},
    {"exp", EXPONENTIAL, false}, {"log", LOGARITHM, false}, {"sin", SINE, false},
    {"cos", COSINE, false},      {"tan", TANGENT, false},
};
enum { FUNCTION_COUNT = sizeof functions / sizeof functions[0] };

static bool refuse(struct parser *parser, const char *text)
{
    return expression_refuse(parser->mistake, parser->position, text);
}

static void emit(struct parser *parser, struct instruction instruction)
{
    struct expression *expression = parser->expression;
    if (expression->count < EXPRESSION_LENGTH_MAX)
        expression->program[expression->count++] = instruction;
}

static void emit_operation(struct parser *parser, enum operation operation, size_t position)
{
    emit(parser, (struct instruction){.operation = operation, .position = position});
}

static bool is_digit(char character)
{
    return character >= '0' && character <= '9';
}

/* Letters beyond ASCII are letters too. */
static bool is_letter(char character)
{
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           character == '_' || (unsigned char)character >= 0x80;
}

/* The next character that is no blank. */
static char peek(struct parser *parser)
{
    while (strchr(" \t\n\r", parser->text[parser->position]) != NULL &&
           parser->text[parser->position] != '\0')
        parser->position++;
    return parser->text[parser->position];
}

static bool take(struct parser *parser, char character)
{
    if (peek(parser) != character)
        return false;
    parser->position++;
    return true;
}

static bool parse_sum(struct parser *parser);

static size_t digits_length(const char *text)
{
    size_t length = 0;
    while (is_digit(text[length]))
        length++;
    return length;
}

static bool parse_number(struct parser *parser)
{
    const char *text = parser->text + parser->position;
    char number[NUMBER_LENGTH_MAX + 1];
    size_t whole = digits_length(text), length = whole;
    size_t part = text[length] == '.' ? digits_length(text + length + 1) : 0;
    length += text[length] == '.' ? 1 + part : 0;
    if (whole + part == 0)
        return refuse(parser, "a digit is wanted beside the point");
    if (text[length] == 'e' || text[length] == 'E') {
        size_t sign = text[length + 1] == '+' || text[length + 1] == '-';
        size_t digits = digits_length(text + length + 1 + sign);
        length += digits == 0 ? 0 : 1 + sign + digits;
    }
    if (length > NUMBER_LENGTH_MAX)
        return refuse(parser, "the number has too many digits");
    memcpy(number, text, length);
    number[length] = '\0';
    double value = strtod(number, NULL);
    if (!isfinite(value))
        return refuse(parser, "the number is too large");
    emit(parser, (struct instruction){
                     .operation = PUSH_NUMBER, .number = value, .position = parser->position});
    parser->position += length;
    return true;
}

static bool parse_call(struct parser *parser, const struct function *function, size_t position)
{
    if (!take(parser, '('))
        return refuse(parser, "a ( is wanted behind a function");
    for (size_t argument = 0;; argument++) {
        size_t comma = parser->position;
        if (!parse_sum(parser))
            return false;
        if (argument > 0)
            emit_operation(parser, function->operation, comma);
        if (!function->many || !take(parser, ','))
            break;
    }
    if (!function->many)
        emit_operation(parser, function->operation, position);
    return take(parser, ')') ||
           refuse(parser, function->many ? "a , or ) is wanted" : "a ) is wanted");
}

static size_t name_length(const char *text)
{
    size_t length = 0;
    while (is_letter(text[length]) || is_digit(text[length]))
        length++;
    return length;
}

static bool parse_name(struct parser *parser)
{
    const char *name = parser->text + parser->position;
    size_t position = parser->position, length = name_length(name);
    for (size_t index = 0; index < FUNCTION_COUNT; index++) {
        const char *function = functions[index].name;
        if (strlen(function) == length && strncmp(function, name, length) == 0) {
            parser->position += length;
            return parse_call(parser, &functions[index], position);
        }
    }
    if (length == 2 && strncmp(name, "pi", 2) == 0) {
        emit(parser,
             (struct instruction){.operation = PUSH_NUMBER, .number = M_PI, .position = position});
        parser->position += length;
        return true;
    }
    int found = parser->find(parser->context, name, length);
    if (found < 0) {
        struct expression_mistake *mistake = parser->mistake;
        int shown = (int)(length < sizeof mistake->name - 1 ? length : sizeof mistake->name - 1);
        (void)refuse(parser, "unknown name");
        (void)snprintf(mistake->name, sizeof mistake->name, "%.*s", shown, name);
        return false;
    }
    emit(parser, (struct instruction){.operation = PUSH_NAME, .name = found, .position = position});
    parser->position += length;
    return true;
}

static bool parse_primary(struct parser *parser)
{
    char next = peek(parser);
    if (is_digit(next) || next == '.')
        return parse_number(parser);
    if (is_letter(next))
        return parse_name(parser);
    if (!take(parser, '('))
        return refuse(parser, next == '\0' ? "it ends where a value is wanted"
                                           : "a number, a name or ( is wanted");
    return parse_sum(parser) && (take(parser, ')') || refuse(parser, "a ) is wanted"));
}

/* Minus signs, and a power. All recursion comes through here. */
static bool parse_signed(struct parser *parser)
{
    bool good;
    if (++parser->depth > DEPTH_MAX)
        return refuse(parser, "it nests too deep");
    (void)peek(parser);
    size_t position = parser->position;
    if (take(parser, '-')) {
        good = parse_signed(parser);
        emit_operation(parser, NEGATE, position);
    } else {
        good = parse_primary(parser);
        (void)peek(parser);
        position = parser->position;
        if (good && take(parser, '^')) {
            good = parse_signed(parser);
            emit_operation(parser, POWER, position);
        }
    }
    parser->depth--;
    return good;
}

static bool parse_product(struct parser *parser)
{
    bool good = parse_signed(parser);
    while (good) {
        char next = peek(parser);
        size_t position = parser->position;
        if (next != '*' && next != '/')
            break;
        parser->position++;
        good = parse_signed(parser);
        emit_operation(parser, next == '*' ? MULTIPLY : DIVIDE, position);
    }
    return good;
}

static bool parse_sum(struct parser *parser)
{
    bool good = parse_product(parser);
    while (good) {
        char next = peek(parser);
        size_t position = parser->position;
        if (next != '+' && next != '-')
            break;
        parser->position++;
        good = parse_product(parser);
        emit_operation(parser, next == '+' ? ADD : SUBTRACT, position);
    }
    return good;
}

struct expression *expression_create(const char *text, expression_find *find, void *context,
                                     struct expression_mistake *mistake)
{
    struct expression *expression = calloc(1, sizeof *expression);
    struct parser parser = {.text = text,
                            .find = find,
                            .context = context,
                            .expression = expression,
                            .mistake = mistake};
    bool good = false;
    if (expression == NULL)
        (void)expression_refuse(mistake, 0, "out of memory");
    else if (strlen(text) > EXPRESSION_LENGTH_MAX)
        (void)expression_refuse(mistake, EXPRESSION_LENGTH_MAX, "the expression is too long");
    else if (parse_sum(&parser))
        good = peek(&parser) == '\0' || refuse(&parser, "an operator is wanted");
    if (!good) {
        free(expression);
        return NULL;
    }
    return expression;
}

bool expression_name_is_valid(const char *name)
{
    size_t length = name_length(name);
    if (length == 0 || is_digit(name[0]) || name[length] != '\0' || strcmp(name, "pi") == 0)
        return false;
    for (size_t index = 0; index < FUNCTION_COUNT; index++) {
        if (strcmp(functions[index].name, name) == 0)
            return false;
    }
    return true;
}
