/* Counts random rays through a cross-section of parabolic arcs (or flat facets): what profiles.simulate is measured against.
   Straightforward C: ray by ray, march from facet to facet or (linear != 0) test them all, mirror reflection, count into bins.
   vertex[2 * (n + 1)], control[2 * n]: one period, x from 0 to 1, highest point at z = 0 on both ends, x ascending.
   table[bins * bins], row phi_i, column phi_o: counts. phi_i is drawn cosine-weighted over its bin. */
#include <math.h>
#include <stdint.h>

static inline float uniform(uint64_t *state) {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (float)((*state * 2685821657736338717ULL) >> 40) * (1.0f / 16777216.0f);
}

/* entering root of cross(d, P(t) - o) on facet k, or -1 */
static inline int hump(const float *v, const float *c, int k) {
    float rx = c[2 * k] - v[2 * k], rz = c[2 * k + 1] - v[2 * k + 1];
    return rx * (v[2 * k + 3] - v[2 * k + 1]) - rz * (v[2 * k + 2] - v[2 * k]) < 0;
}

static inline float root(const float *v, const float *c, int k, float ox, float oz, float dx, float dz, float s0, float s1) {
    float rx = c[2 * k] - v[2 * k], rz = c[2 * k + 1] - v[2 * k + 1];
    float bx = v[2 * k] - 2 * c[2 * k] + v[2 * k + 2], bz = v[2 * k + 1] - 2 * c[2 * k + 1] + v[2 * k + 3];
    float rise = dx * rz - dz * rx, bend = dx * bz - dz * bx;
    if (fabsf(bend) < 1e-9f) return s0 <= 0 && s1 > 0 ? s0 / (s0 - s1) : -1;
    float q = rise * rise - bend * s0;
    if (q < 0) return -1;
    q = sqrtf(q);
    float t = rise > 0 ? -s0 / (rise + q) : (q - rise) / bend;
    return t >= 0 && t <= 1 ? t : -1;
}

static int path(const float *v, const float *c, int n, float x, float phi, int linear, float *out) {
    float dx = -sinf(phi), dz = -cosf(phi), ox = x, oz = 0, t0 = -1;
    int k = (int)(x * n);
    if (k >= n) k = n - 1;
    while (k > 0 && v[2 * k] > x) k--;
    while (k < n - 1 && v[2 * k + 2] <= x) k++;
    for (int bounces = 0; bounces < 2000; bounces++) {
        int hit = -1;
        float t = -1;
        if (bounces > 0) { /* the other crossing of the arc just left */
            float rx = c[2 * k] - v[2 * k], rz = c[2 * k + 1] - v[2 * k + 1];
            float bx = v[2 * k] - 2 * c[2 * k] + v[2 * k + 2], bz = v[2 * k + 1] - 2 * c[2 * k + 1] + v[2 * k + 3];
            float bend = dx * bz - dz * bx, slope = dx * (rz + t0 * bz) - dz * (rx + t0 * bx);
            float other = fabsf(bend) > 1e-9f ? t0 - 2 * slope / bend : -1;
            if (dx >= 0 ? other > t0 && other <= 1 : other < t0 && other >= 0) { hit = k; t = other; }
        }
        if (hit < 0 && linear) {
            float best = 1e30f, s0 = dx * (v[1] - oz) - dz * (v[0] - ox);
            for (int j = 0; j < n; j++) {
                float s1 = dx * (v[2 * j + 3] - oz) - dz * (v[2 * j + 2] - ox);
                if (!(bounces > 0 && j == k) && ((s0 <= 0 && s1 > 0) || hump(v, c, j))) {
                    float u = root(v, c, j, ox, oz, dx, dz, s0, s1);
                    if (u >= 0) {
                        float px = (1 - u) * (1 - u) * v[2 * j] + 2 * u * (1 - u) * c[2 * j] + u * u * v[2 * j + 2];
                        float pz = (1 - u) * (1 - u) * v[2 * j + 1] + 2 * u * (1 - u) * c[2 * j + 1] + u * u * v[2 * j + 3];
                        float far = (px - ox) * dx + (pz - oz) * dz;
                        if (far > -1e-6f && far < best) { best = far; hit = j; t = u; }
                    }
                }
                s0 = s1;
            }
        } else if (hit < 0) {
            int step = dx >= 0 ? 1 : -1, j = bounces > 0 ? k + step : k;
            float near = 0;
            if (j >= 0 && j < n) near = dx * (v[2 * (j + (step < 0)) + 1] - oz) - dz * (v[2 * (j + (step < 0))] - ox);
            for (; j >= 0 && j < n; j += step) {
                int e = j + (step > 0);
                float far = dx * (v[2 * e + 1] - oz) - dz * (v[2 * e] - ox);
                int above = step > 0 ? far > 0 : far <= 0;
                if (above || hump(v, c, j)) {
                    float s0 = step > 0 ? near : far, s1 = step > 0 ? far : near;
                    float u = root(v, c, j, ox, oz, dx, dz, s0, s1);
                    if (u >= 0) { hit = j; t = u; break; }
                    if (above) { hit = j; t = step > 0 ? 1 : 0; break; }
                }
                near = far;
            }
        }
        if (hit < 0) { *out = atan2f(dx, dz); return bounces; }
        float tx = (1 - t) * (c[2 * hit] - v[2 * hit]) + t * (v[2 * hit + 2] - c[2 * hit]);
        float tz = (1 - t) * (c[2 * hit + 1] - v[2 * hit + 1]) + t * (v[2 * hit + 3] - c[2 * hit + 1]);
        float size = 1 / sqrtf(tx * tx + tz * tz), nx = -tz * size, nz = tx * size, cosine = -(dx * nx + dz * nz);
        ox = (1 - t) * (1 - t) * v[2 * hit] + 2 * t * (1 - t) * c[2 * hit] + t * t * v[2 * hit + 2];
        oz = (1 - t) * (1 - t) * v[2 * hit + 1] + 2 * t * (1 - t) * c[2 * hit + 1] + t * t * v[2 * hit + 3];
        dx += 2 * cosine * nx;
        dz += 2 * cosine * nz;
        k = hit;
        t0 = t;
    }
    return -1;
}

void count_rays(const float *v, const float *c, int n, int bins, int rays, int linear, int stratified, uint64_t seed, float *table) {
    const float pi = 3.14159265358979f, width = pi / bins;
#pragma omp parallel for schedule(dynamic, 8)
    for (int i = 0; i < bins; i++) {
        uint64_t state = (seed + 1) * 0x9E3779B97F4A7C15ULL + (uint64_t)i * 0xD1B54A32D192ED03ULL;
        float low = sinf(i * width - pi / 2), high = sinf((i + 1) * width - pi / 2);
        float *row = table + (long)i * bins;
        for (int r = 0; r < rays; r++) {
            float u = uniform(&state), phi = asinf(low + (high - low) * uniform(&state)), out;
            float x = stratified ? (r + u) / rays : u;
            if (path(v, c, n, x, phi, linear, &out) < 1) continue;
            int j = (int)((out + pi / 2) / width);
            row[j < 0 ? 0 : j >= bins ? bins - 1 : j] += 1;
        }
    }
}
