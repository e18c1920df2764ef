# Draws what bench_accuracy measured: gnuplot -e "folder='DIRECTORY'" plot_accuracy.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 1000,1180 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set xlabel "CPU s / simulated s" offset 0,0.5
scenes = "spheres-1 spheres-10 boxes-10 rings-10 bullets curved"
titles = "'balls, 1 %' 'balls, 10 %' 'turned boxes, 10 %' 'rings of 64 triangles, 10 %' \
          'small fast balls among large slow ones' 'balls on parabolas, 1 %'"
of(scene, method) = sprintf("< grep '^%s,%s,' %s/accuracy.csv", scene, method, folder)

# How late a contact is reported, and at what price. Exact methods stand at their own, measured error.
set output folder . "/accuracy.svg"
set multiplot layout 3,2 title "Error of the time of impact against run time, 1 000 bodies; 30 ... 16 000 Hz from left to right" font "sans,15"
set yrange [1e-18:1]
set ylabel "mean error of time, s" offset 1.5,0
do for [i = 1:words(scenes)] {
  s = word(scenes, i)
  set title word(titles, i) offset 0,-0.6
  if (i == 1) { set key at graph 0.98,0.62 right samplen 2 } else { unset key }
  plot of(s, "discrete") using 4:10 with linespoints lw 2 pt 5 ps 0.6 lc rgb "#c0392b" title "sweep and prune over samples", \
       of(s, "polling") using 4:10 with linespoints lw 2 pt 9 ps 0.7 lc rgb "#e67e22" title "kinetic sweep and prune, polled", \
       of(s, "swept") using 4:10 with linespoints lw 2 pt 11 ps 0.7 lc rgb "#7f8c8d" title "swept boxes, exact contacts", \
       of(s, "event-driven") using 4:10 with points pt 7 ps 1.3 lc rgb "#2471a3" title "event-driven, exact contacts"
}
unset multiplot

# The share of contacts that no sample sees.
set terminal svg size 1000,420 font "sans,12" background "white"
set output folder . "/accuracy_missed.svg"
set multiplot layout 1,2 title "Contacts that sampling never sees (exact methods: none)" font "sans,15"
set xlabel "samples a second" offset 0,0.5
set format x "%g"
set xrange [25:20000]
set ylabel "share missed"
set yrange [1e-4:1]
set key default
set key top right
array colour[6] = ["#2471a3", "#16a085", "#8e44ad", "#7f8c8d", "#c0392b", "#e67e22"]
set title "by rate"
plot for [i = 1:words(scenes)] of(word(scenes, i), "discrete") using 3:($8 > 0 ? $8 : 1/0) with linespoints lw 2 pt 7 ps 0.6 \
       lc rgb colour[i] title word(titles, i)
set title "depth at the report, mean, units of length"
set ylabel "depth"
set yrange [1e-5:10]
unset key
plot for [i = 1:words(scenes)] of(word(scenes, i), "discrete") using 3:13 with linespoints lw 2 pt 7 ps 0.6 \
       lc rgb colour[i] title word(titles, i)
unset multiplot

# Energy over many contacts, and what unbiased roundings would make of it.
set terminal svg size 860,480 font "sans,13" background "white"
set output folder . "/drift.svg"
set title "Energy of 64 elastic balls: relative error after so many contacts"
set xlabel "contacts"
set ylabel "|error of energy|"
set format x "10^{%L}"
set xrange [100:1e6]
set yrange [1e-18:1e-12]
set key outside right
cases = "'near' 'mass ratio 1e3' 'mass ratio 1e6' 'clock 1e9' 'coordinates 1e8' 'speed 1e-9' 'speed 1e9' 'gravity'"
array shade[8] = ["#2471a3", "#c0392b", "#e67e22", "#16a085", "#8e44ad", "#7f8c8d", "#b7950b", "#5d6d7e"]
row(name) = sprintf("< grep '^%s,' %s/drift.csv", name, folder)
plot for [i = 1:words(cases)] row(word(cases, i)) using 4:(abs($5)) with linespoints pt 7 ps 0.5 lc rgb shade[i] \
       title word(cases, i), \
     row("near") using 4:6 with lines lw 2 dt 2 lc rgb "black" title "unbiased roundings, near", \
     2.5e-18 * x with lines lw 1 dt 3 lc rgb "black" title "2.5e-18 a contact, all one way"
