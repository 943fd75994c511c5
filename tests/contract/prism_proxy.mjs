// SPDX-License-Identifier: Apache-2.0
// Prism as a proxy in front of daemons: what `prism proxy DOCUMENT UPSTREAM` runs, for as many
// upstreams as a test starts.   node prism_proxy.mjs DOCUMENT
// Prints the port of its control server. GET /PORT answers the port of the proxy in front of
// 127.0.0.1:PORT; violations come back in the header field sl-violations. POST /answers holds an
// answer that could not go through the proxy against the document: { method, path, status, headers,
// body } -> the violations, or null if no operation has the path. Ends with its input.
import http from "node:http";
import { load } from "./packages.mjs";

const { createLogger } = load("@stoplight/prism-core");
const { getHttpOperationsFromSpec } = load("@stoplight/prism-http");
const { default: route } = load("@stoplight/prism-http/dist/router");
const { validateOutput } = load("@stoplight/prism-http/dist/validator");
const { createServer } = load("@stoplight/prism-http-server");

const operations = await getHttpOperationsFromSpec(process.argv[2]);
const logger = createLogger("contract", { level: "silent" });
const severities = ["Error", "Warning", "Information", "Hint"];
const proxies = new Map();

async function proxyOf(upstream) {
    const server = createServer(operations, {
        cors: false,
        config: {
            isProxy: true, upstream: new URL(`http://127.0.0.1:${upstream}`), validateRequest: true,
            validateResponse: true, checkSecurity: true, errors: false, upstreamProxy: undefined,
            mock: { dynamic: false },
        },
        components: { logger },
    });
    return Number(new URL(await server.listen(0, "127.0.0.1")).port);
}

// Names of files have slashes, which a path parameter cannot have; and prism cannot tell the places
// of pictures from those of frames.
function operationOf(method, path) {
    const target = path.split("?")[0].replace(/(\/files\/)(.+)/, (all, folder, name) =>
        folder + encodeURIComponent(name));
    const picture = target.endsWith(".png");
    const resources = operations.filter((operation) =>
        !operation.path.includes("/frames/") || operation.path.endsWith(".png") === picture);
    const found = route({ resources, input: { method: method.toLowerCase(), url: { path: target } } });
    return found._tag === "Right" ? found.right : null;
}

// An answer as the proxy would have read it: JSON is parsed, all else is a text.
function examine({ method, path, status, headers, body }) {
    const resource = operationOf(method, path);
    if (resource === null) return null;
    const json = status !== 206 && /^application\/([a-z]+\+)?json/.test(headers["content-type"] ?? "");
    const element = { statusCode: status, headers,
                      body: body === "" ? undefined : json ? JSON.parse(body) : body };
    const result = validateOutput({ resource, element });
    return result._tag === "Right" ? [] : result.left.map(({ path: place, severity, message }) =>
        ({ location: ["response", ...(place ?? [])], severity: severities[severity], message }));
}

async function text(request) {
    const pieces = [];
    for await (const piece of request) pieces.push(piece);
    return Buffer.concat(pieces).toString();
}

const control = http.createServer(async (request, answer) => {
    if (request.method === "POST") {
        const question = JSON.parse(await text(request));
        try {
            answer.end(JSON.stringify(examine(question)));
        } catch (error) { // an answer that says it is JSON and is not
            answer.end(JSON.stringify([{ location: ["response"], severity: "Error",
                                         message: String(error.stack) }]));
        }
        return;
    }
    const upstream = Number(request.url.slice(1));
    if (!proxies.has(upstream)) proxies.set(upstream, proxyOf(upstream));
    answer.end(String(await proxies.get(upstream)));
});
control.listen(0, "127.0.0.1", () => console.log(control.address().port));
process.stdin.on("end", () => process.exit(0)).resume();
