# SPDX-License-Identifier: Apache-2.0
"""Just enough of JSON Schema (2020-12) to judge an instance: the keywords that the scene schema
uses, and an error for any other keyword."""
import re

TYPES = {
    "object": lambda value: isinstance(value, dict),
    "array": lambda value: isinstance(value, list),
    "string": lambda value: isinstance(value, str),
    "boolean": lambda value: isinstance(value, bool),
    "null": lambda value: value is None,
    "number": lambda value: isinstance(value, (int, float)) and not isinstance(value, bool),
    "integer": lambda value: not isinstance(value, bool) and (
        isinstance(value, int) or isinstance(value, float) and value.is_integer()),
}


def is_number(value):
    return TYPES["number"](value)


def is_type(value, types, _schema):
    return any(TYPES[name](value) for name in ([types] if isinstance(types, str) else types))


def has_only(value, allowed, schema):
    rest = [value[key] for key in value if key not in schema.get("properties", {})] \
        if isinstance(value, dict) else []
    if allowed is False:
        return not rest
    return all(accepts(allowed, entry) for entry in rest)


KEYWORDS = {
    "type": is_type,
    "enum": lambda value, words, _: value in words,
    "const": lambda value, word, _: value == word,
    "oneOf": lambda value, parts, _: sum(accepts(part, value) for part in parts) == 1,
    "anyOf": lambda value, parts, _: any(accepts(part, value) for part in parts),
    "allOf": lambda value, parts, _: all(accepts(part, value) for part in parts),
    "not": lambda value, part, _: not accepts(part, value),
    "required": lambda value, keys, _: not isinstance(value, dict) or all(
        key in value for key in keys),
    "properties": lambda value, parts, _: not isinstance(value, dict) or all(
        accepts(part, value[key]) for key, part in parts.items() if key in value),
    "additionalProperties": has_only,
    "propertyNames": lambda value, part, _: not isinstance(value, dict) or all(
        accepts(part, key) for key in value),
    "minProperties": lambda value, count, _: not isinstance(value, dict) or len(value) >= count,
    "maxProperties": lambda value, count, _: not isinstance(value, dict) or len(value) <= count,
    "items": lambda value, part, _: not isinstance(value, list) or all(
        accepts(part, entry) for entry in value),
    "minItems": lambda value, count, _: not isinstance(value, list) or len(value) >= count,
    "maxItems": lambda value, count, _: not isinstance(value, list) or len(value) <= count,
    "uniqueItems": lambda value, _, __: not isinstance(value, list) or all(
        entry not in value[:index] for index, entry in enumerate(value)),
    "minLength": lambda value, count, _: not isinstance(value, str) or len(value) >= count,
    "maxLength": lambda value, count, _: not isinstance(value, str) or len(value) <= count,
    "pattern": lambda value, text, _: not isinstance(value, str) or bool(re.search(text, value)),
    "minimum": lambda value, bound, _: not is_number(value) or value >= bound,
    "maximum": lambda value, bound, _: not is_number(value) or value <= bound,
    "exclusiveMinimum": lambda value, bound, _: not is_number(value) or value > bound,
    "exclusiveMaximum": lambda value, bound, _: not is_number(value) or value < bound,
    "prefixItems": lambda value, parts, _: not isinstance(value, list) or all(
        accepts(part, entry) for part, entry in zip(parts, value)),
    "dependentRequired": lambda value, needs, _: not isinstance(value, dict) or all(
        other in value for key, others in needs.items() if key in value for other in others),
    "if": lambda value, part, schema: accepts(
        schema.get("then" if accepts(part, value) else "else", True), value),
    "then": lambda *_: True,
    "description": lambda *_: True,
    "default": lambda *_: True,
    "title": lambda *_: True,
    "$schema": lambda *_: True,
}


def accepts(schema, value):
    """True if the schema accepts the value. KeyError for a keyword that is not known here."""
    if isinstance(schema, bool):
        return schema
    return all(KEYWORDS[key](value, argument, schema) for key, argument in schema.items())
