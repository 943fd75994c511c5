// SPDX-License-Identifier: Apache-2.0
// Changes of scenes, most of them for the worse.
const deep = (depth) => {
    let value = 1;
    for (let level = 0; level < depth; level++) value = level % 2 ? [value] : { a: value };
    return value;
};
const ODD = [null, true, false, 0, 1, -1, 2.5, 1e20, 1e30, 1.0000000001e30, -1e31, 1e300, "", "x", "auto",
    [], {}, [1], [1, 2, 3], [null], [[0, 1]], { a: 1 }, deep(30), "é".repeat(48), "é".repeat(49),
    "é".repeat(1000), "é".repeat(1001), "a b"];

// The next number above or below.
function beside(value, up) {
    const size = Math.abs(value) || 1e-300;
    const step = Math.max(size * 2 ** -52, 5e-324);
    return up ? value + step : value - step;
}

// Values that a place of the schema is asked with.
export function probesOf(schema) {
    const values = [];
    for (const word of schema.enum ?? []) values.push(word);
    if ("const" in schema) values.push(schema.const);
    for (const key of ["minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"]) {
        if (!(key in schema)) continue;
        const bound = schema[key], whole = schema.type === "integer";
        values.push(bound, whole ? bound - 1 : beside(bound, false),
            whole ? bound + 1 : beside(bound, true));
    }
    if (schema.type === "integer") values.push(1.5, 2, 3);
    return values;
}

// All containers of a document: { holder, key } of every value below the root.
export function slots(value, found = []) {
    if (value === null || typeof value !== "object") return found;
    for (const key of Object.keys(value)) {
        found.push({ holder: value, key });
        slots(value[key], found);
    }
    return found;
}

const copy = (value) => JSON.parse(JSON.stringify(value));

// One change somewhere; `sampler` makes values for keys that are missing.
export function mutate(scene, random, sampler) {
    const slot = random.pick(slots(scene));
    if (!slot) return;
    const { holder, key } = slot;
    const value = holder[key];
    const kinds = [
        () => { if (Array.isArray(holder)) holder.splice(Number(key), 1); else delete holder[key]; },
        () => { holder[key] = copy(random.pick(ODD)); },
        () => { if (!Array.isArray(holder)) holder[random.pick(["unknown", `${key}s`, ""])] = 1; },
        () => { if (Array.isArray(value)) value.push(copy(value.at(-1) ?? 1)); },
        () => { if (Array.isArray(value)) value.pop(); },
        () => { if (typeof value === "number") holder[key] = random.pick(
            [-value, value * 1e3, value / 7, 0, Math.round(value), value + 0.5, beside(value, true)]); },
        () => { if (typeof value === "string") holder[key] = random.pick(
            [value.toUpperCase(), `${value} `, value.slice(1), `${value}_`, "none", "linear"]); },
        () => graft(scene, random, sampler),
        () => graft(scene, random, sampler),
        () => { if (Array.isArray(value)) holder[key] = { ...value }; },
        () => { const other = random.pick(slots(scene)); holder[key] = copy(other.holder[other.key]); },
    ];
    random.pick(kinds)();
}

// Takes a part of a scene made by the schema: second keys of a group, keys of another kind, ...
function graft(scene, random, sampler) {
    const { steps } = random.pick(sampler.places);
    let from = sampler.scene(steps), to = scene;
    for (const step of steps) {
        if (from === null || typeof from !== "object") return;
        if (typeof step === "number") continue; // an alternative
        const key = step === "*" ? Object.keys(from)[0] : step === "items" ? 0
            : step.startsWith("at:") ? Number(step.slice(3)) : step;
        const target = step === "*" ? Object.keys(to)[0] ?? key : key;
        if (to[target] === undefined || to[target] === null || typeof to[target] !== "object" ||
            random.chance(0.1)) {
            if (from[key] !== undefined) to[target] = from[key];
            return;
        }
        from = from[key];
        to = to[target];
    }
}

export const odd = () => ODD.map(copy);
