# Draws docs/conjunctions.svg: conjunctions --objects 30000 --csv found.csv;
# gnuplot -e "file='found.csv'" plot.gp > conjunctions.svg
if (!exists("file")) file = "found.csv"
set datafile separator ","
set terminal svg size 1000,380 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set multiplot layout 1,2 title "Conjunctions nearer than 5 km of 30 000 objects in 24 hours" font "sans,14"
set xlabel "km high"
set ylabel "conjunctions in 20 km"
set xrange [300:2000]
set style fill solid 0.7 noborder
set boxwidth 20
plot file using (20 * floor($8 / 20) + 10):(1) skip 1 smooth frequency with boxes lc rgb "#2471a3" notitle
set xlabel "closest approach, km"
set ylabel "conjunctions nearer than that"
set logscale xy
set format y "10^{%L}"
set xrange [0.01:5]
set yrange [0.5:1e6]
set key top left
stats file using 5 skip 1 name "D" nooutput
plot file using 5:(1) skip 1 smooth cumulative with lines lw 2 lc rgb "#2471a3" title "found", \
     D_records * (x / 5)**2 with lines dt 2 lc rgb "#c0392b" title "as the square of the distance"
unset multiplot
