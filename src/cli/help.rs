//! Help texts: groups of options, and examples of each command.

use clap::Command;

/// Headings of groups of options, and long names of their options.
const GROUPS: [(&str, &str); 4] = [
    (
        "Results",
        "out best report json residuals plot diagram size show over",
    ),
    (
        "Computation",
        "method tolerance tolerances no-estimate max-evaluations max-events no-motion repeats most-time shard merge",
    ),
    (
        "Figures",
        "reactions torque steady-state fluctuation figures least most subject percentiles forces balance sensitivity details",
    ),
    (
        "Reading the record",
        "column columns time motion known counts-per-turn x-zero skip decimal",
    ),
];

/// Example command lines.
const EXAMPLES: [&str; 16] = [
    "simulate data/spring-press.toml --report press.html",
    "simulate data/duarte-engine.toml --reactions --out rows.csv",
    "inverse data/duarte-engine.toml data/duarte-motion.csv --out forces.csv",
    "identify data/run-down.toml data/run-down.csv --free \"torque[1].coefficient,torque[2].value,crank.inertia,geometry.offset,sensor.zero\"",
    "kinematics data/gupta.toml --every \"1 deg\" --out turn.csv --plot turn.svg",
    "compare data/gupta-clearance-30rpm.toml data/gupta-clearance-300rpm.toml",
    "animate data/gupta.toml --out motion.gif",
    "precision data/brake.toml --tolerances 1e-6,1e-9",
    "statics data/ng.toml --every \"10 deg\" --out statics.csv",
    "sweep data/gupta.toml --vary geometry.offset=0mm:120mm:25 --out designs.csv",
    "sweep data/gupta.toml --vary \"geometry.rod=310 +- 0.1 mm\" --sample 1000 --figures stroke,time_ratio",
    "optimise data/gupta.toml --vary geometry.offset=0mm:120mm --vary geometry.rod=300mm:600mm --most time_ratio --subject \"transmission_min >= 40 deg\"",
    "synthesis --stroke \"90 mm\" --time-ratio 1.2 --out press.toml",
    "reproduce ng",
    "explain data/duarte-cycle.toml --at \"30 deg\"",
    "check data/ng.toml",
];

/// Adds groups and examples to the arguments of the program.
pub(super) fn with_groups(program: Command) -> Command {
    program.mut_subcommands(|one| {
        let own = |line: &&&str| line.split(' ').next() == Some(one.get_name());
        let lines = EXAMPLES.iter().filter(own);
        let lines = lines.map(|line| format!("\n  slider-crank {line}"));
        let lines: String = lines.collect();
        let one = one.mut_args(|argument| {
            let long = argument.get_long().unwrap_or_default();
            let has = |(_, names): &&(&str, &str)| names.split(' ').any(|name| name == long);
            match GROUPS.iter().find(has) {
                Some((heading, _)) => argument.help_heading(*heading),
                None => argument,
            }
        });
        match lines.is_empty() {
            true => one,
            false => one.after_help(format!("Examples:{lines}")),
        }
    })
}
