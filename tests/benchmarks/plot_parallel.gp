# Draws what bench_parallel measured: gnuplot -e "folder='DIRECTORY'" plot_parallel.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 1000,760 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set logscale x
set format x "10^{%L}"
set xlabel "balls" offset 0,0.5
# Balls of one packing in so many threads and domains.
of(packing, threads, domains) = sprintf("< awk -F, '$1 == \"balls\" && $3 == %s && $4 == %d && $5 == %d' %s/parallel.csv", packing, threads, domains, folder)

set output folder . "/parallel.svg"
set multiplot layout 2,2 title "Balls in domains beside one world" font "sans,15"
do for [what in "speed_up cpu known seconds"] {
  if (what eq "speed_up") { set ylabel "times as fast, wall clock"; column = 11; set key top left samplen 2 } else { unset key }
  if (what eq "cpu") { set ylabel "CPU time, all threads / one world"; column = 12 }
  if (what eq "known") { set ylabel "bodies known for one owned"; column = 13 }
  if (what eq "seconds") { set ylabel "simulated seconds a window"; column = 17; set logscale y }
  plot of("0.25", 2, 2) using 2:column with linespoints lw 2 pt 7 lc rgb "#2471a3" title "0.25, two domains, two threads", \
       of("0.01", 2, 2) using 2:column with linespoints lw 2 pt 5 lc rgb "#c0392b" title "0.01, the same", \
       of("0.25", 2, 8) using 2:column with linespoints lw 1 pt 6 lc rgb "#2471a3" title "0.25, eight domains, two threads", \
       of("0.01", 2, 8) using 2:column with linespoints lw 1 pt 4 lc rgb "#c0392b" title "0.01, the same", \
       of("0.25", 1, 2) using 2:column with linespoints dt 2 pt 6 lc rgb "#7f8c8d" title "0.25, two domains, one thread"
}
unset multiplot
