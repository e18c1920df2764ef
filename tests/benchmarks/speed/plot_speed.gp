# Draws what bench_speed measured: gnuplot -e "folder='DIRECTORY'" plot_speed.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 760,480 font "sans,13" background "white"
set grid lc rgb "#dddddd"
is_there(name) = system("test -s " . folder . "/" . name . " && echo 1 || echo 0") eq "1"

if (is_there("speed-ratios.csv")) {
  file = folder . "/speed-ratios.csv"
  set output folder . "/speed-ratios.svg"
  set title "Default over the best of the other methods, cell by cell, sorted"
  set xlabel "cells"
  set ylabel "CPU time, set-up counted / least of the others"
  set logscale y
  stats file using 3 skip 1 nooutput name "low"
  stats file using 4 skip 1 nooutput name "high"
  set yrange [(low_min < 0.6 ? low_min : 0.6):(high_max > 1.4 ? high_max : 1.4)]
  set ytics (0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.15, 1.3, 1.5, 2, 3, 5)
  set key top left
  plot file using 1:2:3:4 skip 1 with yerrorbars pt 7 ps 0.5 lc rgb "#c0392b" title "with set-up, 95 % interval", \
       1.15 with lines dt 2 lc rgb "black" title "1.15"
  unset logscale
  unset yrange
  set ytics auto
}

if (is_there("speed-growth.csv")) {
  set output folder . "/speed-growth.svg"
  set title "CPU time a body for one simulated second: balls, 1 % of the space"
  set xlabel "bodies"
  set ylabel "us a body, set-up and run"
  set logscale xy
  set yrange [*:*]
  set key outside bottom center horizontal
  names = system("tail -n +2 " . folder . "/speed-growth.csv | grep ',0$' | cut -d, -f2 | sort -u")
  of(name) = sprintf("< grep ',%s,' %s/speed-growth.csv | grep ',0$'", name, folder)
  plot for [i = 1:words(names)] of(word(names, i)) using 1:($3 + $4) with linespoints lw 2 pt i title word(names, i)
}
