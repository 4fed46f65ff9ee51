# |Δx|² = (a² + b²) + c² within 3u, its root within 2.52u: components of either sign, away from underflow and overflow.
# check.sh puts in FORMAT, the allowed errors, and a range whose squares are normal numbers.
@rnd = float<FORMAT, ne>;

a = rnd(aa);
b = rnd(bb);
c = rnd(cc);

S rnd = (a * a + b * b) + c * c;
s = (a * a + b * b) + c * c;
L rnd = sqrt(S);
l = sqrt(s);

{ |a| in [LOW, HIGH] /\ |b| in [LOW, HIGH] /\ |c| in [LOW, HIGH]
  -> S -/ s in [-SQUARED, SQUARED] /\ L -/ l in [-LENGTH, LENGTH] }
