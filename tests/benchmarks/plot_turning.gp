# Draws what bench_turning_error measured: gnuplot -e "folder='DIRECTORY'" plot_turning.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 1100,420 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set xlabel "CPU us a pair, mean" offset 0,0.5
set ylabel "mean error of time, s" offset 1.5,0
set xrange [0.5:2e4]
set yrange [1e-17:1]
of(turn, method) = sprintf("< grep '^%s,%s,' %s/turning-error.csv", turn, method, folder)
set output folder . "/turning_error.svg"
set multiplot layout 1,3 title "Boxes that turn: error of the time of contact against run time. Sampling: 60 ... 16 000 Hz; FCL: 1 ... 4 000 frames" font "sans,14"
do for [turn in "1 10 100"] {
  set title turn . " rad in a second" offset 0,-0.6
  if (turn eq "1") { set key at graph 0.98,0.5 right samplen 2 } else { unset key }
  plot of(turn, "sampling") using 4:5 with linespoints lw 2 pt 5 ps 0.6 lc rgb "#c0392b" title "sampling", \
       of(turn, "FCL") using 4:5 with linespoints lw 2 pt 9 ps 0.9 lc rgb "#27ae60" title "FCL", \
       of(turn, "Bullet") using 4:5 with points pt 11 ps 1.2 lc rgb "#7f8c8d" title "Bullet", \
       of(turn, "here") using 4:5 with points pt 7 ps 1.3 lc rgb "#2471a3" title "here"
}
unset multiplot
