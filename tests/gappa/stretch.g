# k(l − l₀)/l at the stored l within 3.01u: one difference, one product, one division, each of normal numbers.
# check.sh puts in FORMAT, the allowed error, and a range that keeps products normal. That the difference D and the product P
# are away from 0 is told, not found.
@rnd = float<FORMAT, ne>;

k = rnd(kk);
l = rnd(ll);
z = rnd(zz);
D = rnd(l - z);
P = rnd(k * D);
T = rnd(P / l);

{ k in [LOW, HIGH] /\ l in [LOW, HIGH] /\ |l - z| in [LOW, HIGH] /\ |D| in [LOW, HIGH] /\ |P| in [LEAST, MOST]
  -> T -/ (k * (l - z) / l) in [-STRETCH, STRETCH] }
