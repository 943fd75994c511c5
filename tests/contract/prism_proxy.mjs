// SPDX-License-Identifier: Apache-2.0
// Prism as a proxy in front of daemons: what `prism proxy DOCUMENT UPSTREAM` runs, for as many
// upstreams as a test starts.   node prism_proxy.mjs DOCUMENT
// Prints the port of its control server, which answers GET /PORT with the port of the proxy in front
// of 127.0.0.1:PORT. Violations come back in the header field sl-violations. Ends with its input.
import http from "node:http";
import { load } from "./packages.mjs";

const { createLogger } = load("@stoplight/prism-core");
const { getHttpOperationsFromSpec } = load("@stoplight/prism-http");
const { createServer } = load("@stoplight/prism-http-server");

const operations = await getHttpOperationsFromSpec(process.argv[2]);
const logger = createLogger("contract", { level: "silent" });
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

const control = http.createServer(async (request, answer) => {
    const upstream = Number(request.url.slice(1));
    if (!proxies.has(upstream)) proxies.set(upstream, proxyOf(upstream));
    answer.end(String(await proxies.get(upstream)));
});
control.listen(0, "127.0.0.1", () => console.log(control.address().port));
process.stdin.on("end", () => process.exit(0)).resume();
