// Menger sponge as nested unions of cubes; Level is declared on the command line. Lit by the cosine of the angle to
// the light, seen from azimuth 30 and elevation 25 in parallel projection.
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { color rgb 1 }
camera {
  orthographic
  location <0.5, 0.5, 0.5> + 10 * <0.453, 0.4226, -0.785>
  right 1.75 * x
  up 1.75 * y
  look_at <0.5, 0.5, 0.5>
}
light_source { <0.5, 0.5, 0.5> + 1000 * <0.453, 0.4226, -0.785> color rgb 1 parallel point_at <0.5, 0.5, 0.5> shadowless }
#declare Sponge = box { 0, 1 }
#declare N = 0;
#while (N < Level)
  #declare Sponge = union {
    #declare I = 0;
    #while (I < 27)
      #declare X = mod(I, 3);
      #declare Y = mod(floor(I / 3), 3);
      #declare Z = floor(I / 9);
      #if ((X = 1) + (Y = 1) + (Z = 1) < 2)
        object { Sponge scale 1 / 3 translate <X, Y, Z> / 3 }
      #end
      #declare I = I + 1;
    #end
  }
  #declare N = N + 1;
#end
object { Sponge pigment { color rgb <1, 0.84, 0.47> } finish { ambient 0 diffuse 1 } }
