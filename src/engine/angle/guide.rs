//! Known run as first guess of a finer one: the change made by a sweep is then the defect of the guide.

use super::AngleRun;
use super::cycle_panels::PanelShape;
use super::panel::PanelTable;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;

impl AngleRun {
    /// Returns the shapes of the panels of a cycle, if the run began at this angle.
    pub(super) fn shapes_from(&self, angle: Angle) -> Option<&[PanelShape]> {
        let first = self.shapes.first()?;
        let is_same = (first.turns, first.ends[0]) == (angle.turns, angle.rest);
        is_same.then_some(&self.shapes)
    }

    /// Returns the kinetic energy (J) of this run at the points of a panel after `turns` whole turns, shifted to
    /// `start` at the first point. None beyond the end, and where the energy is not positive.
    pub(super) fn kinetic<P: Copy>(
        &self,
        panel: &PanelTable<P>,
        turns: f64,
        start: f64,
    ) -> Option<Values> {
        let (segment, count) = (self.orbit.last_segment(), panel.rule.degree() + 1);
        // Angles, of which the kinetic energy there takes the place.
        let mut kinetic = panel.rule.values(|x| panel.piece.angle(x));
        let mut done = 0;
        while done < count {
            let (index, _) = segment.located(Angle::new(turns, kinetic[done]))?;
            let known = segment.panels.get(index)?;
            let local = |angle: &f64| known.local(Angle::new(turns, *angle));
            let left = &mut kinetic[done..count];
            let is_on = |angle: &&f64| known.piece.nearest(local(angle)).is_some();
            let more = left.iter().skip(1).take_while(is_on).count();
            let points = &mut left[..=more];
            points.iter_mut().for_each(|angle| *angle = local(angle));
            known.slowness(points);
            for (point, inertia) in points.iter_mut().zip(&panel.table.inertia[done..]) {
                let speed = 1.0 / *point;
                *point = 0.5 * inertia * speed * speed;
            }
            done += points.len();
        }
        let moved = start - kinetic[0];
        kinetic[..count].iter_mut().for_each(|one| *one += moved);
        // Between its points a series is no guide where the inertia nearly vanishes.
        let is_energy = |one: &f64| *one > 0.0 && one.is_finite();
        kinetic[..count].iter().all(is_energy).then_some(kinetic)
    }
}
