#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a bare Debian 12 machine to a debris flow that hits a column: installs the packages, builds,
# starts a daemon of its own, submits the scene over HTTP, follows it live, and says where picture
# and results lie. Run it again to run the scene again. QUICKSTART_STATE: folder of the daemon's
# state (default: build/quickstart).
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
state=${QUICKSTART_STATE:-$root/build/quickstart}
scene=clients/scenes/mast-7.4-column-impact.json
export PATH=$root/build/release/bin:$PATH
unset TALUS_TOKEN

say() {
    printf '\n== %s\n' "$*"
}

answers() {
    curl --silent --fail --noproxy '*' --max-time 5 --output /dev/null "$1/healthz"
}

# A port that nothing listens on: the default one or one of the next.
free_port() {
    local port
    for port in $(seq 8465 8564); do
        if ! (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
            echo "$port"
            return
        fi
    done
    echo "no free port between 8465 and 8564" >&2
    return 1
}

# Leaves the address in TALUS_SERVER; takes up a daemon that an earlier run has left.
start_daemon() {
    mkdir -p "$state"
    if [ -s "$state/address" ] && answers "$(cat "$state/address")"; then
        TALUS_SERVER=$(cat "$state/address")
        export TALUS_SERVER
        return
    fi
    local port
    port=$(free_port)
    export TALUS_SERVER=http://127.0.0.1:$port
    setsid talusd --state "$state" --listen "127.0.0.1:$port" >"$state/talusd.log" 2>&1 </dev/null &
    echo $! >"$state/talusd.pid"
    echo "$TALUS_SERVER" >"$state/address"
    for _ in $(seq 100); do
        if answers "$TALUS_SERVER"; then
            return
        fi
        sleep 0.1
    done
    echo "talusd does not answer; its output:" >&2
    cat "$state/talusd.log" >&2
    return 1
}

# A figure of the finished job, by its name.
metric() {
    talus show "$1" | awk -v name="$2" '$1 == name { print $2 }'
}

begin=$SECONDS
say "packages"
deploy/install-dependencies.sh

say "build"
cmake --preset release >/dev/null
cmake --build --preset release

say "daemon"
start_daemon
echo "talusd answers at $TALUS_SERVER, state in $state"

say "scene"
submitted=$(talus submit "$scene" --name "column impact" --threads 0)
echo "$submitted"
id=${submitted%% *}

say "run"
talus watch "$id" --reaction column

say "forces on the column's front face"
peak=$(metric "$id" reaction.column.x_min.peak)
steady=$(metric "$id" probe.load.mean)
# The load of a soil at rest of the initial depth: 0.5 K0 rho g H^2 w, with K0 = nu / (1 - nu) out
# of the scene's elastic constants (Mast 2013, section 7.4).
awk -v peak="$peak" -v steady="$steady" 'BEGIN {
    bulk = 8.33e6; shear = 3.85e6; density = 1950.55; gravity = 10; depth = 3; width = 2
    k0 = (3 * bulk - 2 * shear) / (3 * bulk + 4 * shear)
    at_rest = 0.5 * k0 * density * gravity * depth ^ 2 * width
    printf "peak              %8.1f kN\n", peak / 1e3
    printf "steady            %8.1f kN  (mean from 2.5 s on)\n", steady / 1e3
    printf "0.5 K0 rho g H^2 w %7.1f kN  (K0 = %.3f, H = 3 m, w = 2 m)\n", at_rest / 1e3, k0
}'

picture=$state/column-impact.png
curl --silent --show-error --fail --noproxy '*' --output "$picture" \
    "$TALUS_SERVER/v1/jobs/$id/frames/12.png?field=velocity&width=1200"

say "done in $((SECONDS - begin)) s"
cat <<END
picture        $picture
ParaView       $state/jobs/$id/frames.hdf.series
h5py           $state/jobs/$id/results.h5
all forces     build/release/bin/talus reactions $id --server $TALUS_SERVER
stop talusd    kill $(cat "$state/talusd.pid")
END
