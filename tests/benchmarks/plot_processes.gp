# Draws what bench_processes counted and predicted: gnuplot -e "folder='DIRECTORY'" plot_processes.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 1000,800 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set logscale x 2
set xlabel "domains" offset 0,0.5
of(packing, bodies) = sprintf("< awk -F, '$2 == %s && $1 == %s' %s/processes.csv", packing, bodies, folder)

set output folder . "/processes.svg"
set multiplot layout 2,2 title "What a division costs: counted (points), and predicted (lines)" font "sans,15"
do for [what in "known efficiency messages bytes"] {
  if (what eq "known") { set ylabel "bodies known for one owned"; column = 8; set key top left samplen 2 } else { unset key }
  if (what eq "efficiency") { set ylabel "efficiency by counts"; column = 11 }
  if (what eq "messages") { set ylabel "messages a process and step"; column = 13 }
  if (what eq "bytes") { set ylabel "bytes a process and step"; column = 15 }
  plot of("0.25", "30000") using 3:column with points pt 6 lc rgb "#2471a3" title "30 000 balls, 0.25", \
       of("0.25", "30000") using 3:column + 1 with lines lc rgb "#2471a3" notitle, \
       of("0.25", "100000") using 3:column with points pt 7 lc rgb "#2471a3" title "100 000, 0.25", \
       of("0.25", "100000") using 3:column + 1 with lines lc rgb "#2471a3" notitle, \
       of("0.01", "30000") using 3:column with points pt 4 lc rgb "#c0392b" title "30 000, 0.01", \
       of("0.01", "30000") using 3:column + 1 with lines lc rgb "#c0392b" notitle, \
       of("0.01", "100000") using 3:column with points pt 5 lc rgb "#c0392b" title "100 000, 0.01", \
       of("0.01", "100000") using 3:column + 1 with lines lc rgb "#c0392b" notitle
}
unset multiplot
