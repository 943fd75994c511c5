// SPDX-License-Identifier: Apache-2.0
// Makes scenes out of the JSON Schema of scenes. A scene can be steered to hold a given place of the
// schema: `want` is the list of steps from the root to it (property names, "items", "*" for the
// values of a map, "at:N" for an entry of a list, numbers for alternatives of a oneOf).
const WORDS = ["soil", "heap", "floor", "runout"];

const axesOf = (dimension) => (dimension === "line" ? 1 : dimension === "solid" ? 3 : 2);

export class SceneSampler {
    constructor(schema, random) {
        this.schema = schema;
        this.random = random;
        this.axes = 2;
    }

    scene(want = []) {
        const words = this.schema.properties.dimension.enum;
        const dimension = this.random.pick(words);
        this.axes = axesOf(dimension);
        const scene = this.object(this.schema, want, 0);
        scene.dimension = dimension;
        return scene;
    }

    value(schema, want, depth) {
        if ("const" in schema) return schema.const;
        if (schema.enum) return this.random.pick(schema.enum);
        if (schema.oneOf && !schema.properties) return this.alternative(schema.oneOf, want, depth);
        switch (schema.type) {
            case "object":
                return this.object(schema, want, depth);
            case "array":
                return this.array(schema, want, depth);
            case "string":
                return this.text(schema);
            case "boolean":
                return this.random.chance(0.5);
            default:
                return this.number(schema);
        }
    }

    alternative(alternatives, want, depth) {
        if (typeof want[0] === "number")
            return this.value(alternatives[want[0]], want.slice(1), depth);
        const models = alternatives.filter((entry) => !this.turns(entry, alternatives));
        return this.value(this.random.pick(models.length ? models : alternatives), want, depth);
    }

    // A turn is a number in a plane and three numbers in space.
    turns(entry, alternatives) {
        const rate = alternatives.length === 2 && alternatives.every(
            (one) => one.type === "number" || (one.type === "array" && one.minItems === 3));
        return rate && (entry.type === "array") !== (this.axes === 3);
    }

    length(schema) {
        const low = schema.minItems ?? 0, high = schema.maxItems ?? 3;
        if (high - low === 2 && high <= 3) return this.axes + high - 3;
        return Math.min(high, Math.max(low, this.random.below(3)));
    }

    array(schema, want, depth) {
        const list = [];
        let count = this.length(schema);
        if (want.length > 0) count = Math.max(count, 1);
        for (let index = 0; index < count; index++) {
            const entry = schema.prefixItems ? schema.prefixItems[index] : schema.items;
            const wanted = schema.prefixItems ? want[0] === `at:${index}` : want[0] === "items";
            list.push(this.value(entry, wanted && (index === 0 || schema.prefixItems) ? want.slice(1) : [], depth + 1));
        }
        return schema.uniqueItems ? [...new Set(list)] : list;
    }

    text(schema) {
        if (schema.pattern && !/^\^\[A-Za-z/.test(schema.pattern))
            return this.random.pick(["x_min", "y_max", "side_0", "side_1_to_2", "outside"]);
        return this.random.pick(WORDS);
    }

    number(schema) {
        const low = schema.minimum ?? schema.exclusiveMinimum ?? -10;
        const high = schema.maximum ?? schema.exclusiveMaximum ?? 10;
        const nice = [0, 1, 0.5, 2, 0.25, 0.001, 20, 1000, -1, 1e6].filter(
            (value) => value > low && value < high &&
                (schema.type !== "integer" || Number.isInteger(value)));
        if (nice.length > 0) return this.random.pick(nice.slice(0, 5));
        return schema.type === "integer" ? Math.ceil((low + high) / 2) : (low + high) / 2;
    }

    object(schema, want, depth) {
        const object = {};
        if (!schema.properties) {
            const name = this.random.pick(WORDS);
            object[name] = this.value(schema.additionalProperties,
                want[0] === "*" ? want.slice(1) : [], depth + 1);
            return object;
        }
        const required = new Set(schema.required ?? []);
        for (const [key, member] of Object.entries(schema.properties)) {
            if (required.has(key) || key === want[0] || this.random.chance(depth > 2 ? 0.3 : 0.2))
                object[key] = this.value(member, key === want[0] ? want.slice(1) : [], depth + 1);
        }
        this.repair(schema, object, want[0], depth);
        return object;
    }

    // Makes the object agree with groups of alternatives, needs and rules, keeping `kept`.
    repair(schema, object, kept, depth) {
        const add = (key) => {
            if (!(key in object)) object[key] = this.value(schema.properties[key], [], depth + 1);
        };
        for (const [key, words] of this.discriminators(schema)) {
            if (key in object && kept && kept !== key)
                object[key] = this.random.pick(words.filter(
                    (word) => !this.rules(schema, key, word).some(
                        (rule) => rule.properties?.[kept] === false)));
        }
        for (let round = 0; round < 4; round++) {
            for (const part of schema.allOf ?? []) {
                if (part.oneOf) this.group(part.oneOf, object, kept, add);
                if (part.if) this.rule(part, object, add);
            }
            for (const [key, others] of Object.entries(schema.dependentRequired ?? {})) {
                if (!(key in object)) continue;
                if (key === kept || others.includes(kept)) others.forEach(add);
                else if (others.some((other) => !(other in object))) delete object[key];
            }
        }
    }

    discriminators(schema) {
        const found = new Map();
        for (const part of schema.allOf ?? []) {
            const [key, test] = Object.entries(part.if?.properties ?? {})[0] ?? [];
            if (test && "const" in test) found.set(key, schema.properties[key].enum);
        }
        return found;
    }

    rules(schema, key, word) {
        return schema.allOf.filter((part) => part.if?.properties?.[key]?.const === word)
            .map((part) => part.then);
    }

    group(alternatives, object, kept, add) {
        const keys = alternatives.flatMap((one) => one.required ?? []);
        const given = keys.filter((key) => key in object);
        const chosen = keys.includes(kept) ? kept
            : given.length ? this.random.pick(given)
                : keys.length === alternatives.length ? this.random.pick(keys) : null;
        if (chosen) add(chosen);
        for (const key of keys) if (key !== chosen) delete object[key];
    }

    rule(part, object, add) {
        const [key, test] = Object.entries(part.if.properties)[0];
        if (!("const" in test) || object[key] !== test.const) return;
        for (const [other, allowed] of Object.entries(part.then.properties ?? {}))
            if (allowed === false) delete object[other];
        (part.then.required ?? []).forEach(add);
        if (part.then.anyOf && !part.then.anyOf.some((one) => one.required.every((k) => k in object)))
            this.random.pick(part.then.anyOf).required.forEach(add);
    }
}

// Every place of the schema as a list of steps, with the schema there.
export function places(schema, steps = [], found = []) {
    if (typeof schema !== "object") return found;
    found.push({ steps, schema });
    for (const [key, member] of Object.entries(schema.properties ?? {}))
        places(member, [...steps, key], found);
    if (typeof schema.additionalProperties === "object")
        places(schema.additionalProperties, [...steps, "*"], found);
    if (schema.items) places(schema.items, [...steps, "items"], found);
    (schema.prefixItems ?? []).forEach((entry, index) => places(entry, [...steps, `at:${index}`], found));
    if (schema.oneOf && !schema.properties)
        schema.oneOf.forEach((entry, index) => places(entry, [...steps, index], found));
    return found;
}
