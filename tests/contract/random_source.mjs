// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same in every run (mulberry32).
export class RandomSource {
    constructor(seed) {
        this.state = seed >>> 0;
    }

    number() {
        this.state = (this.state + 0x6d2b79f5) >>> 0;
        let mixed = Math.imul(this.state ^ (this.state >>> 15), this.state | 1);
        mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
        return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
    }

    below(count) {
        return Math.floor(this.number() * count);
    }

    chance(share) {
        return this.number() < share;
    }

    pick(list) {
        return list[this.below(list.length)];
    }
}
