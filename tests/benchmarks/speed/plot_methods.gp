# Draws the methods by bodies and by rate, as bench_speed measured them: gnuplot -e "folder='DIRECTORY'" plot_methods.gp
if (!exists("folder")) folder = "."
set datafile separator ","
set grid lc rgb "#dddddd"
set style data linespoints
set format y "10^{%L}"
set logscale y
names = system("tail -n +2 " . folder . "/bodies.csv | cut -d, -f2 | awk '!seen[$0]++'")
of(file, name) = sprintf("< grep ',%s,' %s/%s.csv", name, folder, file)

set terminal svg size 760,520 font "sans,13" background "white"
set output folder . "/bodies.svg"
set key outside bottom center horizontal
set title "CPU seconds a simulated second: rings of 64 triangles, 1 % density, 1 000 Hz"
set xlabel "bodies"
set ylabel "CPU s / simulated s"
set y2label "contacts"
set y2tics
set y2range [0:*]
set ytics nomirror
plot for [i = 1:words(names)] of("bodies", word(names, i)) using 1:3 title word(names, i) lw 2 pt i + 3, \
     of("bodies", word(names, 1)) using 1:6 axes x1y2 title "contacts (right)" with lines dt 3 lc rgb "black"

# [Coming06] Figure 8: a panel for each method.
columns = 2
rows = (words(names) + columns - 1) / columns
set terminal svg size 900,300 * rows font "sans,12" background "white"
set output folder . "/frequency.svg"
unset y2tics
unset y2label
unset key
set logscale x
set yrange [1e-6:10]
set key bottom left samplen 2
set multiplot layout rows,columns title "CPU seconds a simulated second by kind of work: 1 000 rings"
do for [i = 1:words(names)] {
  set title word(names, i)
  set xlabel "frames a second"
  plot of("frequency", word(names, i)) using 1:3 title "all" lw 3 pt 7, \
       of("frequency", word(names, i)) using 1:5 title "update" dt 2 pt 6, \
       of("frequency", word(names, i)) using 1:6 title "sort" dt 3 pt 4, \
       of("frequency", word(names, i)) using 1:7 title "prune" dt 5 pt 12, \
       of("frequency", word(names, i)) using 1:8 title "test" dt 4 pt 8
}
unset multiplot
