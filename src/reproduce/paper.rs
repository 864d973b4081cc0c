//! The four papers: names and authors.

named! {
    /// Paper on the slider-crank.
    pub enum Paper {
        /// Obaseki and Alfred 2020, Modeling and investigating the effect of offset distance on slider-crank mechanism.
        ObasekiAlfred = "obaseki-alfred",
        /// Gupta, Offset slider-crank mechanism.
        Gupta = "gupta",
        /// Ng, A slider-crank experiment to determine the action of static forces.
        Ng = "ng",
        /// Duarte, Valencia and Obregon 2018, Application of Lagrange equations in the analysis of slider-crank
        /// mechanisms.
        Duarte = "duarte",
    }
}

impl Paper {
    /// Returns the authors.
    pub fn authors(self) -> &'static str {
        match self {
            Paper::ObasekiAlfred => "Obaseki and Alfred",
            Paper::Gupta => "Gupta",
            Paper::Ng => "Ng",
            Paper::Duarte => "Duarte et al.",
        }
    }
}
