//! Whether a motion passes a fold at a turning point or goes back.

use super::super::sensor::Sensor;
use super::evidence::{ENOUGH, Evidence};
use super::record::Record;
use super::strokes::{Fold, Stroke, Strokes};
use super::turnings::Turning;
use super::window::{Window, turned_back};

/// Ways from a fold, rad, within which a motion is looked at: one may be simpler near the fold, another one plainer farther
/// from it.
const FAR: [f64; 4] = [0.6, 1.2, 0.25, 2.0];

/// Ways that are so short that noise may bend a motion, and how many times as long they are to be as noise blurs the fold.
const NEAR: [f64; 2] = [0.1, 0.04];
const SHARP: f64 = 20.0;

/// Turning points on either side between which it is looked at if that does not decide.
const WIDE: [usize; 3] = [2, 3, 1];

/// Part of the evidence that may be against what decides.
const OPPOSED: f64 = 0.5;

/// Part of the evidence that decides with which another range supports one that leaves more than noise.
const SUPPORT: f64 = 0.125;

/// A motion whose strokes are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<'a> {
    pub record: Record<'a>,
    pub strokes: &'a Strokes<'a>,
    pub turnings: &'a [Turning],
}

/// A turning point at a fold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visit {
    pub fold: Fold,
    pub passes: bool,
    /// Whether the samples tell.
    pub certain: bool,
}

impl Visit {
    /// A certain passage.
    pub fn passage(fold: Fold) -> Visit {
        Visit {
            fold,
            passes: true,
            certain: true,
        }
    }

    /// The stroke after it.
    pub fn next(self, stroke: Stroke) -> Stroke {
        if self.passes {
            stroke ^ self.fold.change
        } else {
            stroke
        }
    }
}

impl Motion<'_> {
    /// The fold of a turning point, if the motion may have been there.
    pub fn fold(&self, k: usize) -> Option<Fold> {
        let Turning { at, above } = self.turnings[k];
        let fold = self.strokes.fold(self.record.values[at], above);
        fold.filter(|fold| self.record.reaches(at, fold.value))
    }

    /// By how much some standard deviations of noise change the angle of a value on a stroke, rad.
    pub fn blur(&self, value: f64, stroke: Stroke, deviations: f64) -> f64 {
        let noise = self.record.noise + self.record.rounding;
        let angle = |value: f64| self.strokes.angles(value)[stroke];
        [-deviations, deviations]
            .map(|by| turned_back(angle(value + by * noise) - angle(value)).abs())
            .into_iter()
            .fold(0.0, f64::max)
    }

    /// Looks at a turning point to which the motion comes on a stroke.
    pub fn look(&self, k: usize, fold: Fold, stroke: Stroke) -> Visit {
        let at = self.turnings[k].at;
        let at_fold = self.strokes.angles(fold.value)[stroke];
        let off = |i: usize| {
            turned_back(self.strokes.angles(self.record.values[i])[stroke] - at_fold).abs()
        };
        let between = self.between(k, 1);
        let blur = self.blur(fold.value, stroke, 1.0);
        let near = NEAR.into_iter().filter(|near| *near > SHARP * blur);
        let ranges = FAR
            .into_iter()
            .chain(near)
            .map(|far| between.map(|end| search(at, end, |i| off(i) <= far)));
        let (passes, certain) = self.weigh(k, fold, |_| stroke, ranges);
        Visit {
            fold,
            passes,
            certain,
        }
    }

    /// Looks again at one that is not certain, with more of the motion: its strokes between turning points are taken as
    /// they are, or those after this one the other way round.
    pub fn look_again(&self, k: usize, visit: Visit, along: impl Fn(usize) -> Stroke) -> Visit {
        let at = self.turnings[k].at;
        let back = |i: usize| {
            let stroke = along(self.turnings.partition_point(|turning| turning.at < i));
            if i > at { visit.next(stroke) } else { stroke }
        };
        let ranges = WIDE.into_iter().map(|wide| self.between(k, wide));
        match self.weigh(k, visit.fold, back, ranges) {
            (passes, true) => Visit {
                passes,
                certain: true,
                ..visit
            },
            _ => visit,
        }
    }

    /// Whether a sample is a turning point.
    pub fn turns_at(&self, sample: usize) -> bool {
        let at = self
            .turnings
            .binary_search_by_key(&sample, |turning| turning.at);
        at.is_ok()
    }

    /// The samples of other turning points on either side.
    pub fn between(&self, k: usize, away: usize) -> [usize; 2] {
        let at = |k: Option<usize>| {
            k.and_then(|k| self.turnings.get(k))
                .map(|turning| turning.at)
        };
        let [before, after] = [at(k.checked_sub(away)), at(Some(k + away))];
        [before.unwrap_or(0), after.unwrap_or(self.record.last())]
    }

    /// What ranges of samples tell: whether the motion passes, and whether that is certain.
    fn weigh(
        &self,
        k: usize,
        fold: Fold,
        back: impl Fn(usize) -> Stroke,
        ranges: impl Iterator<Item = [usize; 2]>,
    ) -> (bool, bool) {
        let mut list = Vec::new();
        for range in ranges {
            let one = self.evidence(k, fold, &back, range);
            list.push(one);
            if one.is_clear() {
                break;
            }
        }
        verdict(&list)
    }

    /// What a range of samples tells of a passage, where a motion that goes `back` has these strokes.
    pub fn evidence(
        &self,
        k: usize,
        fold: Fold,
        back: impl Fn(usize) -> Stroke,
        range: [usize; 2],
    ) -> Evidence {
        let at = self.turnings[k].at;
        let at_fold = self.strokes.angles(fold.value)[back(at)];
        let linkage = self.strokes.linkage_at(fold, at_fold);
        let sensor = Sensor {
            linkage: &linkage,
            measured: self.strokes.sensor.measured,
        };
        let window = Window::new(self, (at, fold), back, range);
        Evidence::of(&window, &sensor)
    }
}

/// Whether a motion passes, and whether that is certain: what leaves nothing but noise counts before what leaves more, of which one
/// range alone does not decide unless it is clear.
fn verdict(list: &[Evidence]) -> (bool, bool) {
    let ends = |list: &mut dyn Iterator<Item = &Evidence>| {
        list.fold([0.0f64; 2], |[least, most], one| {
            [least.min(one.passes), most.max(one.passes)]
        })
    };
    let decides = |[least, most]: [f64; 2]| {
        let opposed = most.min(-least);
        (least + most).abs() >= ENOUGH && opposed < OPPOSED * ENOUGH
    };
    let passes = |[least, most]: [f64; 2]| least + most > 0.0;
    let stays_off = list.iter().any(|one| one.stays_off);
    let good = ends(&mut list.iter().filter(|one| one.explained));
    if (good[0] + good[1]).abs() >= ENOUGH {
        return (passes(good), decides(good) && (passes(good) || stays_off));
    }
    let all = ends(&mut list.iter());
    let sign = (all[0] + all[1]).signum();
    let supports = |one: &&Evidence| sign * one.passes > SUPPORT * ENOUGH;
    let supported = list.iter().any(Evidence::is_clear) || list.iter().filter(supports).count() > 1;
    (
        passes(all),
        decides(all) && supported && (passes(all) || stays_off),
    )
}

/// The farthest sample on the way from one to another up to which all are inside.
pub(super) fn search(from: usize, to: usize, inside: impl Fn(usize) -> bool) -> usize {
    if inside(to) {
        return to;
    }
    let (mut near, mut far) = (from, to);
    while near.abs_diff(far) > 1 {
        let middle = usize::midpoint(near, far);
        if inside(middle) {
            near = middle;
        } else {
            far = middle;
        }
    }
    near
}
