//! A source with all its mutants in it, each asleep behind `crate::mutation::m(number)`.
//!
//! Comments mark where each site (E) and each mutant (A) begins and ends, so that a compiler's error finds its own.

use std::ops::Range;

use crate::find::{Kind, Site};

/// How a site is woven; what the compiler refuses goes one further.
#[derive(Clone, Copy, PartialEq)]
pub enum Manner {
    /// Operands of a comparison by reference, as the comparison itself takes them.
    Reference,
    /// By value.
    Value,
    /// Not at all.
    Left,
}

/// A source, where its mutants go and how.
pub struct Weaver<'a> {
    pub source: &'a str,
    pub sites: &'a [Site],
    /// By site.
    pub manners: &'a [Manner],
    /// Mutants that do not compile.
    pub refused: &'a dyn Fn(usize) -> bool,
}

fn m(number: usize) -> String {
    format!("crate::mutation::m({number})")
}

impl Weaver<'_> {
    /// All of the source.
    pub fn text(&self) -> String {
        self.render(0..self.source.len(), 0)
    }

    /// So many bytes of the source, with what is woven into them, of the sites from one on.
    fn render(&self, range: Range<usize>, from: usize) -> String {
        let mut text = String::new();
        let mut at = range.start;
        for (index, site) in self.sites.iter().enumerate().skip(from) {
            if site.range.start >= range.end {
                break;
            }
            if site.range.start < at || site.range.end > range.end {
                continue;
            }
            text += &self.source[at..site.range.start];
            text += &self.site(index, site);
            at = site.range.end;
        }
        text + &self.source[at..range.end]
    }

    fn site(&self, index: usize, site: &Site) -> String {
        let live: Vec<&(usize, String)> =
            site.mutants.iter().filter(|(number, _)| !(self.refused)(*number)).collect();
        let inner = |range: &Range<usize>| self.render(range.clone(), index + 1);
        if live.is_empty() || self.manners[index] == Manner::Left {
            return inner(&site.range);
        }
        let marked = |number: usize, text: &str| format!("/*<A{number}*/{text}/*A{number}>*/");
        let woven = match &site.kind {
            Kind::Body => {
                let mut text = String::new();
                for (number, value) in live {
                    text += &format!("if {} {{ return {}; }} ", m(*number), marked(*number, value));
                }
                text + &inner(&site.range)
            }
            Kind::Arm => {
                let text = inner(&site.range);
                // Only an arm without a guard: none other is listed so far.
                format!("{text} if !{}", marked(live[0].0, &m(live[0].0)))
            }
            Kind::Guard => {
                let mut text = format!("({})", inner(&site.range));
                for (number, value) in live {
                    text = match value.as_str() {
                        "true" => format!("({} || {text})", m(*number)),
                        _ => format!("(!{} && {text})", m(*number)),
                    };
                }
                text
            }
            Kind::Field { name, value, base } => {
                let (number, _) = live[0];
                let taken = marked(*number, &format!("({}).{name}", &self.source[base.clone()]));
                format!("{name}: if {} {{ {taken} }} else {{ {} }}", m(*number), inner(value))
            }
            Kind::Unary { op, operand } => {
                let (number, _) = live[0];
                let without = marked(*number, "v__");
                format!(
                    "(match ({}) {{ v__ => if {} {{ {without} }} else {{ {op}v__ }} }})",
                    inner(operand),
                    m(*number)
                )
            }
            Kind::Binary { left, op, right } => {
                let (l, r) = (inner(left), inner(right));
                // One look which of the site's mutants is awake: they have numbers in a row.
                let (first, last) = (site.mutants[0].0, site.mutants[site.mutants.len() - 1].0);
                let choice = |left: &str| {
                    let mut text = format!("match crate::mutation::site({first}, {}) {{ ", last + 1 - first);
                    for (number, other) in &live {
                        let changed = marked(*number, &format!("{left} {other} r__"));
                        text += &format!("{} => {{ {changed} }} ", number + 1 - first);
                    }
                    text + &format!("_ => {{ {left} {op} r__ }} }}")
                };
                match op.as_str() {
                    "&&" => format!(
                        "(match ({l}) {{ l__ => if l__ != {0} {{ {r} }} else {{ {0} }} }})",
                        m(live[0].0)
                    ),
                    "||" => format!(
                        "(match ({l}) {{ l__ => if l__ == {0} {{ {r} }} else {{ !{0} }} }})",
                        m(live[0].0)
                    ),
                    "==" | "!=" | "<" | "<=" | ">" | ">=" if self.manners[index] == Manner::Reference => {
                        format!("(match (&({l}), &({r})) {{ (l__, r__) => {} }})", choice("l__"))
                    }
                    _ if op.ends_with('=') && !matches!(op.as_str(), "==" | "!=" | "<=" | ">=") => {
                        format!("match ({r}) {{ r__ => {{ {} }} }}", choice(&l))
                    }
                    _ => format!("(match (({l}), ({r})) {{ (l__, r__) => {} }})", choice("l__")),
                }
            }
        };
        format!("/*<E{index}*/{woven}/*E{index}>*/")
    }
}
