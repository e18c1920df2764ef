# Draws what bench_roots measured: gnuplot -e "folder='DIRECTORY'" plot_roots.gp
# A point a solver: filled where no other is both faster and more often right, blue where its answer is certified.
if (!exists("folder")) folder = "."
file = folder . "/roots-summary.csv"
set datafile separator ","
set datafile columnheaders
set terminal svg size 1080,760 font "sans,12" background "white"
set logscale xy
set grid lc rgb "#dddddd"
set format x "%.0f"
unset key
degrees = "2 3 4 5 6 8"

blue = 0x2471a3
red = 0xc0392b
colour(certified) = certified > 0 ? blue : red
shape(front) = front > 0 ? 7 : 6
of(degree) = column("degree") == degree ? column("ordinary_ns") : NaN

array least[8]
array most[8]
unset logscale
do for [degree = 1:8] {
  stats file using (of(degree)) nooutput
  least[degree] = STATS_min / 2
  most[degree] = STATS_max * 8
}
set logscale xy

named = 'with labels left rotate by 45 offset 0.4,0.4 font "sans,10"'

# The share of wrong answers; those that had none stand on the lowest line.
none = 1e-5
share(x) = column("wrong") > 0 ? column("wrong") / column("polynomials") : none
set output folder . "/roots-wrong.svg"
set multiplot layout 2,3 title "Finding when a polynomial turns negative: time against wrong answers"
set yrange [none / 3 : 30]
set ytics ("none" none, "0.01 %%" 1e-4, "0.1 %%" 1e-3, "1 %%" 1e-2, "10 %%" 1e-1, "100 %%" 1)
do for [d in degrees] {
  degree = int(d)
  set xrange [least[degree] : most[degree]]
  set title "degree " . d
  set xlabel "ns a call, ordinary families"
  set ylabel "wrong answers, all families"
  plot file using (of(degree)):(share(0)):(shape(column("front"))):(colour(column("certified"))) \
         with points pt variable lc rgb variable ps 0.9, \
       file using (of(degree)):(share(0)):(strcol("solver")) @named
}
unset multiplot

# The largest error among the crossings rightly reported.
set output folder . "/roots-ulps.svg"
set multiplot layout 2,3 title "Finding when a polynomial turns negative: time against error of the crossings reported"
set yrange [0.2 : 1e18]
set ytics ("1" 1, "10^3" 1e3, "10^6" 1e6, "10^9" 1e9, "10^{12}" 1e12)
do for [d in degrees] {
  degree = int(d)
  set xrange [least[degree] : most[degree]]
  set title "degree " . d
  set xlabel "ns a call, ordinary families"
  set ylabel "largest error, ulps, all families"
  plot file using (of(degree)):(column("ulps_max")):(shape(column("front"))):(colour(column("certified"))) \
         with points pt variable lc rgb variable ps 0.9, \
       file using (of(degree)):(column("ulps_max")):(strcol("solver")) @named
}
unset multiplot
