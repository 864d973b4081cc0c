//! One step of the explicit Runge-Kutta method DOP853 of Dormand and Prince on a state of fixed size: order 8, with
//! error estimates of orders 5 and 3 and dense output of order 7, with the coefficients of Hairer, Nørsett and Wanner,
//! Solving Ordinary Differential Equations I, 2nd ed. 1993, II.5 and II.6. Nodes are the row sums.

/// Stages of one step from `start`, along any independent variable.
#[derive(Clone, Debug)]
pub(super) struct Stages<const N: usize> {
    k: [[f64; N]; 13],
    start: [f64; N],
    length: f64,
    /// State at the end.
    pub end: [f64; N],
}

#[inline(always)]
fn sum<const N: usize>(k: &[[f64; N]], terms: &[Term]) -> [f64; N] {
    let mut total = [0.0; N];
    for (stage, weight) in terms {
        for i in 0..N {
            total[i] += weight * k[*stage][i];
        }
    }
    total
}

#[inline(always)]
fn moved<const N: usize>(
    start: &[f64; N],
    length: f64,
    k: &[[f64; N]],
    terms: &[Term],
) -> [f64; N] {
    let mut end = sum(k, terms);
    for i in 0..N {
        end[i] = start[i] + length * end[i];
    }
    end
}

/// Node of a stage: the sum of its coefficients.
const fn node(terms: &[Term]) -> f64 {
    let (mut total, mut i) = (0.0, 0);
    while i < terms.len() {
        total += terms[i].1;
        i += 1;
    }
    total
}

impl<const N: usize> Stages<N> {
    /// Computes the step of this length. `rates(c, y)`: rate at the fraction c of the step; `first`: rate at its start.
    #[inline]
    pub fn new(
        rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N],
        start: &[f64; N],
        first: &[f64; N],
        length: f64,
    ) -> Stages<N> {
        let mut k = [[0.0; N]; 13];
        k[0] = *first;
        macro_rules! stages {
            ($($index:literal)*) => {$(
                let terms = const { STAGES[$index - 1] };
                k[$index] = rates(const { node(STAGES[$index - 1]) }, &moved(start, length, &k, terms));
            )*};
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11);
        let end = moved(start, length, &k, STAGES[11]);
        Stages {
            k,
            start: *start,
            length,
            end,
        }
    }

    /// Sets the rate at the end, which the dense output needs.
    pub fn set_last_rate(&mut self, rate: [f64; N]) {
        self.k[12] = rate;
    }

    /// Estimates the local error in units of `scale`, root mean square over the first `counted` components: the
    /// estimate of order 5, reduced where that of order 3 is larger still (Hairer, Nørsett and Wanner, II.10).
    pub fn error(&self, scale: &[f64; N], counted: usize) -> f64 {
        let (fifth, third) = (sum(&self.k, ERRORS[0]), sum(&self.k, ERRORS[1]));
        let (mut five, mut three) = (0.0, 0.0);
        for i in 0..counted {
            let (a, b) = (fifth[i] / scale[i], third[i] / scale[i]);
            five += a * a;
            three += b * b;
        }
        if five == 0.0 && three == 0.0 {
            return 0.0;
        }
        self.length.abs() * five / ((five + 0.01 * three) * counted as f64).sqrt()
    }

    /// Computes the dense output of order 7; three more evaluations.
    pub fn dense(&self, rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N]) -> Dense<N> {
        let mut k = [[0.0; N]; 16];
        k[..13].copy_from_slice(&self.k);
        let (start, h) = (&self.start, self.length);
        macro_rules! stages {
            ($($index:literal)*) => {$(
                let terms = const { DENSE_STAGES[$index] };
                k[13 + $index] = rates(const { node(DENSE_STAGES[$index]) }, &moved(start, h, &k, terms));
            )*};
        }
        stages!(0 1 2);
        macro_rules! higher {
            ($($index:literal)*) => {[$(sum(&k, const { DENSE[$index] }),)*]};
        }
        let higher = higher!(0 1 2 3);
        let mut terms = [[0.0; N]; 7];
        for i in 0..N {
            let rise = self.end[i] - start[i];
            terms[0][i] = rise;
            terms[1][i] = h * k[0][i] - rise;
            terms[2][i] = 2.0 * rise - h * (k[12][i] + k[0][i]);
            for (term, higher) in terms[3..].iter_mut().zip(&higher) {
                term[i] = h * higher[i];
            }
        }
        Dense {
            start: *start,
            terms,
        }
    }
}

/// Dense output of a step, as a function of u in [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Dense<const N: usize> {
    start: [f64; N],
    terms: [[f64; N]; 7],
}

impl<const N: usize> Dense<N> {
    /// Returns the state at u.
    pub fn at(&self, u: f64) -> [f64; N] {
        let mut y = [0.0; N];
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.number(i, u);
        }
        y
    }

    /// Returns one number of the state at u.
    #[inline(always)]
    pub fn number(&self, i: usize, u: f64) -> f64 {
        let (t, rest) = (&self.terms, 1.0 - u);
        let inner = t[3][i] + u * (t[4][i] + rest * (t[5][i] + u * t[6][i]));
        self.start[i] + u * (t[0][i] + rest * (t[1][i] + u * (t[2][i] + rest * inner)))
    }
}

/// Index of a stage and its coefficient.
type Term = (usize, f64);

/// Rows of the Runge-Kutta matrix for stages 1 to 11, then the weights of the end of the step.
#[rustfmt::skip]
const STAGES: [&[Term]; 12] = [
    &[(0, 0.05260015195876773)],
    &[(0, 0.0197250569845379), (1, 0.0591751709536137)],
    &[(0, 0.02958758547680685), (2, 0.08876275643042054)],
    &[(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)],
    &[(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)],
    &[(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)],
    &[
        (0, 0.03709200011850479), (3, 0.17038392571223998), (4, 0.10726203044637328), (5, -0.015319437748624402),
        (6, 0.008273789163814023),
    ],
    &[
        (0, 0.6241109587160757), (3, -3.3608926294469414), (4, -0.868219346841726), (5, 27.59209969944671),
        (6, 20.154067550477894), (7, -43.48988418106996),
    ],
    &[
        (0, 0.47766253643826434), (3, -2.4881146199716677), (4, -0.590290826836843), (5, 21.230051448181193),
        (6, 15.279233632882423), (7, -33.28821096898486), (8, -0.020331201708508627),
    ],
    &[
        (0, -0.9371424300859873), (3, 5.186372428844064), (4, 1.0914373489967295), (5, -8.149787010746927),
        (6, -18.52006565999696), (7, 22.739487099350505), (8, 2.4936055526796523), (9, -3.0467644718982196),
    ],
    &[
        (0, 2.273310147516538), (3, -10.53449546673725), (4, -2.0008720582248625), (5, -17.9589318631188),
        (6, 27.94888452941996), (7, -2.8589982771350235), (8, -8.87285693353063), (9, 12.360567175794303),
        (10, 0.6433927460157636),
    ],
    &[
        (0, 0.054293734116568765), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585),
        (8, 0.3111643669578199), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.04471061572777259),
    ],
];

/// Weights of the error estimates of orders 5 and 3.
#[rustfmt::skip]
const ERRORS: [&[Term]; 2] = [
    &[
        (0, 0.01312004499419488), (5, -1.2251564463762044), (6, -0.4957589496572502), (7, 1.6643771824549864),
        (8, -0.35032884874997366), (9, 0.3341791187130175), (10, 0.08192320648511571), (11, -0.022355307863886294),
    ],
    &[
        (0, -0.18980075407240762), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585),
        (8, -0.4226823213237919), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.02265179219836082),
    ],
];

/// Rows of the Runge-Kutta matrix for stages 13 to 15, which only the dense output needs.
#[rustfmt::skip]
const DENSE_STAGES: [&[Term]; 3] = [
    &[
        (0, 0.056167502283047954), (6, 0.25350021021662483), (7, -0.2462390374708025), (8, -0.12419142326381637),
        (9, 0.15329179827876568), (10, 0.00820105229563469), (11, 0.007567897660545699), (12, -0.008298),
    ],
    &[
        (0, 0.03183464816350214), (5, 0.028300909672366776), (6, 0.053541988307438566), (7, -0.05492374857139099),
        (10, -0.00010834732869724932), (11, 0.0003825710908356584), (12, -0.00034046500868740456),
        (13, 0.1413124436746325),
    ],
    &[
        (0, -0.42889630158379194), (5, -4.697621415361164), (6, 7.683421196062599), (7, 4.06898981839711),
        (8, 0.3567271874552811), (12, -0.0013990241651590145), (13, 2.9475147891527724), (14, -9.15095847217987),
    ],
];

/// Weights of terms 4 to 7 of the dense output.
#[rustfmt::skip]
const DENSE: [&[Term]; 4] = [
    &[
        (0, -8.428938276109013), (5, 0.5667149535193777), (6, -3.0689499459498917), (7, 2.38466765651207),
        (8, 2.117034582445028), (9, -0.871391583777973), (10, 2.2404374302607883), (11, 0.6315787787694688),
        (12, -0.08899033645133331), (13, 18.148505520854727), (14, -9.194632392478356), (15, -4.436036387594894),
    ],
    &[
        (0, 10.427508642579134), (5, 242.28349177525817), (6, 165.20045171727028), (7, -374.5467547226902),
        (8, -22.113666853125306), (9, 7.733432668472264), (10, -30.674084731089398), (11, -9.332130526430229),
        (12, 15.697238121770845), (13, -31.139403219565178), (14, -9.35292435884448), (15, 35.81684148639408),
    ],
    &[
        (0, 19.985053242002433), (5, -387.0373087493518), (6, -189.17813819516758), (7, 527.8081592054236),
        (8, -11.57390253995963), (9, 6.8812326946963), (10, -1.0006050966910838), (11, 0.7777137798053443),
        (12, -2.778205752353508), (13, -60.19669523126412), (14, 84.32040550667716), (15, 11.99229113618279),
    ],
    &[
        (0, -25.69393346270375), (5, -154.18974869023643), (6, -231.5293791760455), (7, 357.6391179106141),
        (8, 93.40532418362432), (9, -37.45832313645163), (10, 104.0996495089623), (11, 29.8402934266605),
        (12, -43.53345659001114), (13, 96.32455395918828), (14, -39.17726167561544), (15, -149.72683625798564),
    ],
];
