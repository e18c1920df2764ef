# Draws docs/free_trajectory.svg: free_trajectory 8 1 gaps.csv; gnuplot -e "file='gaps.csv'" plot.gp > free_trajectory.svg
if (!exists("file")) file = "gaps.csv"
set datafile separator ","
set terminal svg size 760,380 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set key top center
set xlabel "s"
set ylabel "from the ball to the cable, m"
set xrange [12.355:12.455]
set yrange [-0.05:]
set title "Drone 0 passes the cable: samples at 100 Hz, and what is between" font "sans,14"
plot file using 1:2 skip 1 with lines lw 2 lc rgb "#2471a3" title "all of its way", \
     file using 1:2 skip 1 every 100::100 with points pt 7 ps 0.8 lc rgb "#c0392b" title "samples", \
     0 with lines lw 1 lc rgb "black" notitle
