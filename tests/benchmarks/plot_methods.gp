# Draws what bench_methods measured: gnuplot -e "folder='DIRECTORY'" plot_methods.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set terminal svg size 760,520 font "sans,13" background "white"
set key outside bottom center horizontal
set grid lc rgb "#dddddd"
set style data linespoints
array colour[3] = ["#c0392b", "#2471a3", "#7f8c8d"]

set output folder . "/bodies.svg"
set title "CPU seconds a simulated second: rings of 64 triangles, 1 % density, 1 000 Hz"
set xlabel "bodies"
set ylabel "CPU s / simulated s"
set y2label "contacts"
set y2tics
set y2range [0:*]
set ytics nomirror
set logscale y
set format y "10^{%L}"
of(name) = sprintf("< grep ',%s,' %s/bodies.csv", name, folder)
plot of("kinetic-sap") using 1:3 title "kinetic sweep and prune" lw 2 pt 7 lc rgb colour[1], \
     of("sap") using 1:3 title "sweep and prune, swept boxes" lw 2 pt 5 lc rgb colour[2], \
     of("all-pairs") using 1:3 title "cached, all pairs" lw 2 pt 9 lc rgb colour[3], \
     of("kinetic-sap") using 1:5 axes x1y2 title "contacts (right)" with lines dt 3 lc rgb "black"

set output folder . "/frequency.svg"
set title "CPU seconds a simulated second by kind of work: 1 000 rings"
set xlabel "frames a second"
unset y2tics
unset y2label
set logscale x
set yrange [1e-6:*]
of(name) = sprintf("< grep ',%s,' %s/frequency.csv", name, folder)
plot of("kinetic-sap") using 1:3 title "kinetic: all" lw 3 pt 7 lc rgb colour[1], \
     of("kinetic-sap") using 1:4 title "update" dt 2 pt 6 lc rgb colour[1], \
     of("kinetic-sap") using 1:5 title "sort" dt 3 pt 4 lc rgb colour[1], \
     of("kinetic-sap") using 1:6 title "prune" dt 5 pt 12 lc rgb colour[1], \
     of("kinetic-sap") using 1:7 title "test" dt 4 pt 8 lc rgb colour[1], \
     of("sap") using 1:3 title "swept: all" lw 3 pt 5 lc rgb colour[2], \
     of("sap") using 1:4 title "update" dt 2 pt 6 lc rgb colour[2], \
     of("sap") using 1:5 title "sort" dt 3 pt 4 lc rgb colour[2], \
     of("sap") using 1:6 title "prune" dt 5 pt 12 lc rgb colour[2], \
     of("sap") using 1:7 title "test" dt 4 pt 8 lc rgb colour[2]
