# Draws docs/granular_gas.svg from equation.csv, gas.csv and shear.csv, as docs/granular_gas.md makes them:
# gnuplot plot.gp > granular_gas.svg
set datafile separator ","
set terminal svg size 1000,700 font "sans,12" background "white"
set grid lc rgb "#dddddd"
set multiplot layout 2,2 title "Gases of hard balls in a periodic box" font "sans,14"
blue = "#2471a3"
red = "#c0392b"
set key top left
set xlabel "packing fraction"
set ylabel "P V / (N T)"
p(x) = (1 + x + x**2 - x**3) / (1 - x)**3
set xrange [0:0.5]
plot p(x) with lines lc rgb red title "Carnahan and Starling", \
     "equation.csv" using 1:2 skip 1 with points pt 7 ps 0.7 lc rgb blue title "measured"
set key bottom left
set ylabel "diffusion over Enskog's"
set yrange [0.4:1.4]
n(x) = 6 * x / pi
plot (1 - n(x) / 1.09) * (1 + n(x)**2 * (0.4 - 0.83 * n(x)**2)) * (1 - x / 2) / (1 - x)**3 with lines lc rgb red \
       title "fit of Speedy", \
     "equation.csv" using 1:($10 / $11):($9 / $11) skip 1 with yerrorbars pt 7 ps 0.7 lc rgb blue title "measured"
set autoscale y
set key top right
set xrange [1:3]
set xlabel "distance, diameters"
set ylabel "radial distribution, packing 0.4"
plot "gas.csv" using 1:2 skip 1 with lines lw 2 lc rgb blue title "measured", \
     "< echo 1,5.5" using 1:((1 - 0.4 / 2) / 0.6**3) with points pt 2 ps 1.2 lc rgb red title "contact, Carnahan and Starling"
set xrange [0:*]
set yrange [0:*]
set key bottom right
set xlabel "s"
set ylabel "temperature, sheared"
plot "shear.csv" using 1:2 skip 1 with lines lw 2 lc rgb blue title "restitution 0.9", \
     "shear.csv" using 1:(1.334) skip 1 with lines dt 2 lc rgb red title "balance with Enskog's viscosity"
unset multiplot
