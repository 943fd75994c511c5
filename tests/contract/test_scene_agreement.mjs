// SPDX-License-Identifier: Apache-2.0
// The JSON Schema of scenes and the reader of scenes agree on structure: a scene is valid by the
// schema (judged by ajv) exactly if the reader finds no mistake of the class "structure".
//   node test_scene_agreement.mjs WORKER ROOT [COUNT [SEED]]
// TALUS_FULL=1 takes 100,000 scenes, TALUS_CONTRACT_SCENES=1 prints those that are judged differently.
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { createInterface } from "node:readline";
import { load } from "./packages.mjs";
import { RandomSource } from "./random_source.mjs";
import { mutate, odd, probesOf } from "./scene_mutations.mjs";
import { SceneSampler, places } from "./scene_sampler.mjs";

const [worker, root, countText, seedText = "1"] = process.argv.slice(2);
const wanted = Number(countText ?? (process.env.TALUS_FULL ? 100000 : 5000)), BATCH = 100;
const Ajv2020 = load("ajv/dist/2020.js").default;
const copy = (value) => JSON.parse(JSON.stringify(value));

class Helper {
    constructor() {
        this.process = spawn(worker, ["helper"], { stdio: ["pipe", "pipe", "inherit"] });
        this.lines = createInterface({ input: this.process.stdout })[Symbol.asyncIterator]();
    }

    async ask(question) {
        this.process.stdin.write(`${JSON.stringify(question)}\n`);
        const { value, done } = await this.lines.next();
        if (done) throw new Error("the helper ended");
        return JSON.parse(value);
    }

    close() {
        this.process.stdin.end();
    }
}

// Scenes that the repository ships and tests with.
function shipped() {
    const scenes = [];
    const walk = (folder) => {
        for (const entry of fs.readdirSync(folder, { withFileTypes: true })) {
            const name = path.join(folder, entry.name);
            if (entry.isDirectory()) walk(name);
            else if (entry.name.endsWith(".json")) {
                const document = JSON.parse(fs.readFileSync(name));
                for (const scene of [document, document.scene])
                    if (scene?.dimension && scene.bodies) scenes.push(scene);
            }
        }
    };
    walk(path.join(root, "clients", "scenes"));
    walk(path.join(root, "tests"));
    return scenes;
}

// The value at the steps of a scene that was made for them: { holder, key }.
function locate(scene, steps) {
    let at = { holder: { scene }, key: "scene" };
    for (const step of steps) {
        const value = at.holder[at.key];
        if (typeof step === "number") continue; // an alternative
        if (value === null || typeof value !== "object") return null;
        const key = step === "*" ? Object.keys(value)[0] : step === "items" ? 0
            : step.startsWith("at:") ? Number(step.slice(3)) : step;
        at = { holder: value, key };
        if (at.key === undefined || at.holder[at.key] === undefined) return null;
    }
    return at;
}

// Every place of the schema, with every value that its schema or a careless user could ask with.
function* systematic(sampler) {
    for (const { steps, schema } of sampler.places) {
        if (steps.length === 0) continue;
        yield sampler.scene(steps);
        for (const value of [...probesOf(schema), ...odd()]) {
            const scene = sampler.scene(steps), at = locate(scene, steps);
            if (at === null) continue;
            at.holder[at.key] = value;
            yield scene;
        }
        const scene = sampler.scene(steps), at = locate(scene, steps);
        if (at === null) continue;
        if (!Array.isArray(at.holder)) delete at.holder[at.key];
        yield scene;
        const unknown = sampler.scene(steps), there = locate(unknown, steps);
        if (there?.holder[there.key]?.constructor === Object) there.holder[there.key].unknown = 1;
        yield unknown;
    }
}

function* random(sampler, source, seeds) {
    for (;;) {
        const scene = source.chance(0.3) ? sampler.scene(source.pick(sampler.places).steps)
            : copy(source.pick(seeds));
        for (let change = source.below(4); change > 0; change--) mutate(scene, source, sampler);
        yield scene;
    }
}

const helper = new Helper();
const { schema } = await helper.ask({ op: "schema" });
const { describe } = await helper.ask({ op: "describe" });
const classes = new Map(describe.codes.map(({ code, class: kind }) => [code, kind]));
const validate = new Ajv2020({ strict: false }).compile(schema);
const source = new RandomSource(Number(seedText));
const sampler = new SceneSampler(schema, source);
sampler.places = places(schema);
const missed = sampler.places.filter(({ steps }) => locate(sampler.scene(steps), steps) === null);

const seeds = shipped();
const all = [...systematic(sampler)];
// A reduced run takes half of its scenes from the systematic ones, spread evenly.
const share = Math.min(all.length, Math.max(1, Math.floor(wanted / 2)));
const scenes = [...seeds];
for (let index = 0; index < share; index++)
    scenes.push(all[Math.floor((index * all.length) / share)]);
const more = random(sampler, source, seeds);
while (scenes.length < wanted) scenes.push(more.next().value);

const kinds = new Map();
const tally = { valid: 0, accepted: 0, disagreements: 0, unknown: new Set() };
for (let first = 0; first < scenes.length; first += BATCH) {
    const batch = scenes.slice(first, first + BATCH);
    const { answers } = await helper.ask({ op: "check_many", scenes: batch });
    batch.forEach((scene, index) => {
        const errors = answers[index].errors ?? [];
        for (const { code } of errors) if (!classes.has(code)) tally.unknown.add(code);
        const structural = errors.filter(({ code }) => classes.get(code) === "structure");
        const valid = validate(scene);
        tally.valid += valid;
        tally.accepted += answers[index].ok;
        if (valid === (structural.length === 0)) return;
        tally.disagreements++;
        const what = valid
            ? `reader only: ${structural[0].code} ${structural[0].pointer.replace(/\d+/g, "N")}`
            : `schema only: ${validate.errors.map((e) => `${e.instancePath.replace(/\d+/g, "N")} ${e.keyword}`).join(", ").slice(0, 200)} (reader: ${errors.map((e) => `${e.code} ${e.pointer}`).slice(0, 3)})`;
        if (!kinds.has(what)) kinds.set(what, { count: 0, scene });
        kinds.get(what).count++;
    });
}
helper.close();

console.log(`${scenes.length} scenes (${seeds.length} of the repository, ${share} of ` +
    `${all.length} systematic ones): ${tally.valid} valid by the schema, ${tally.accepted} ` +
    `accepted, ${tally.disagreements} disagreements`);
for (const [what, { count, scene }] of [...kinds].sort((a, b) => b[1].count - a[1].count).slice(0, 40)) {
    console.log(`${count} x ${what}`);
    if (process.env.TALUS_CONTRACT_SCENES) console.log(`    ${JSON.stringify(scene).slice(0, 3000)}`);
}
for (const code of tally.unknown) console.log(`the code ${code} is not in the list that describe tells`);
for (const { steps } of missed) console.log(`no scene was made with ${steps.join("/")}`);
// Both verdicts must be common, or the test says nothing.
const enough = tally.valid > scenes.length / 20 && tally.valid < scenes.length * 0.95;
if (!enough) console.log("nearly all scenes are of one kind");
process.exit(tally.disagreements > 0 || tally.unknown.size > 0 || missed.length > 0 || !enough ? 1 : 0);
