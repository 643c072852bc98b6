# Synthetic ground motion for earthquake.toml: awk -f accelerogram.awk > accelerogram.csv
#
#   a(t) = e(t) Σ_k sqrt(2 S(f_k) Δf) cos(2π f_k t + φ_k),   f_k = 0.3 Hz + (k − 1/2) Δf,  Δf = 0.16 Hz,  k = 1..60
#
# with the spectrum of Kanai and Tajimi, S(f) = (1 + 4ζ²r²)/((1 − r²)² + 4ζ²r²), r = f/2.5 Hz, ζ = 0.6, and an envelope e that
# rises as (t/2 s)² to 2 s, stays 1 to 6 s and falls as exp(−0.6 (t − 6 s)). Phases φ_k = 2π frac(c k²) with c the golden
# ratio for y and √2 for z: no random numbers, so that every awk writes the same record. Scaled to largest
# accelerations of 1.5 m/s² along y and 1 m/s² along z.
function frac(x) { return x - int(x) }
function motion(t, c,    k, f, r, S, sum) {
  sum = 0
  for (k = 1; k <= 60; ++k) {
    f = 0.3 + (k - 0.5) * 0.16
    r = f / 2.5
    S = (1 + 1.44 * r * r) / ((1 - r * r) ^ 2 + 1.44 * r * r)
    sum += sqrt(2 * S * 0.16) * cos(2 * pi * (f * t + frac(c * k * k)))
  }
  return (t < 2 ? (t / 2) ^ 2 : t < 6 ? 1 : exp(-0.6 * (t - 6))) * sum
}
BEGIN {
  pi = atan2(0, -1)
  for (i = 0; i <= 1000; ++i) {
    y[i] = motion(0.01 * i, (1 + sqrt(5)) / 2)
    z[i] = motion(0.01 * i, sqrt(2))
    if (y[i] ^ 2 > ym ^ 2) ym = y[i] < 0 ? -y[i] : y[i]
    if (z[i] ^ 2 > zm ^ 2) zm = z[i] < 0 ? -z[i] : z[i]
  }
  print "# Synthetic accelerogram, made by accelerogram.awk, which says how"
  print "t[s],y[m/s2],z[m/s2]"
  for (i = 0; i <= 1000; ++i) printf "%.2f,%.4f,%.4f\n", 0.01 * i, 1.5 * y[i] / ym, z[i] / zm
}
