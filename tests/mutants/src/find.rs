//! Where in a source the listed places are: the expressions around them, by syn.

use std::collections::HashMap;
use std::ops::Range;

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::mutant::{Mutant, Result};

/// A place where mutants are woven in: bytes of the source, and the numbers of its mutants.
pub struct Site {
    pub range: Range<usize>,
    pub kind: Kind,
    pub mutants: Vec<(usize, String)>,
}

pub enum Kind {
    /// A function's body.
    Body,
    /// A match arm: its pattern's end comes last.
    Arm,
    /// The guard of a match arm.
    Guard,
    /// `field: value` or `field` of a struct with a base.
    Field { name: String, value: Range<usize>, base: Range<usize> },
    /// left op right
    Binary { left: Range<usize>, op: String, right: Range<usize> },
    /// op operand
    Unary { op: String, operand: Range<usize> },
}

impl Kind {
    /// Of sites with the same bytes, the outer one first.
    fn rank(&self) -> u8 {
        match self {
            Kind::Body => 0,
            Kind::Field { .. } => 1,
            Kind::Guard => 2,
            Kind::Arm => 3,
            Kind::Binary { .. } | Kind::Unary { .. } => 4,
        }
    }
}

struct Finder<'a> {
    /// By genre's group and place.
    wanted: HashMap<(u8, usize, usize), Vec<(usize, String)>>,
    source: &'a str,
    sites: Vec<Site>,
}

fn group(genre: &str) -> u8 {
    match genre {
        "FnValue" => 0,
        "MatchArm" => 1,
        "MatchArmGuard" => 2,
        "StructField" => 3,
        _ => 4,
    }
}

impl Finder<'_> {
    fn take(&mut self, genre: &str, at: Span) -> Option<Vec<(usize, String)>> {
        let start = at.start();
        self.wanted.remove(&(group(genre), start.line, start.column + 1))
    }

    fn site(&mut self, range: Range<usize>, kind: Kind, mutants: Vec<(usize, String)>) {
        self.sites.push(Site { range, kind, mutants });
    }

    fn body(&mut self, block: &syn::Block) {
        let (Some(first), Some(last)) = (block.stmts.first(), block.stmts.last()) else { return };
        if let Some(mutants) = self.take("FnValue", first.span()) {
            self.site(first.span().byte_range().start..last.span().byte_range().end, Kind::Body, mutants);
        }
    }
}

fn has_let(expr: &syn::Expr) -> bool {
    match expr {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.body(&item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.body(&item.block);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.body(block);
        }
        visit::visit_trait_item_fn(self, item);
    }

    fn visit_expr_binary(&mut self, expr: &'ast syn::ExprBinary) {
        if !has_let(&expr.left)
            && !has_let(&expr.right)
            && let Some(mutants) = self.take("BinaryOperator", expr.op.span())
        {
            let op = self.source[expr.op.span().byte_range()].to_owned();
            let kind = Kind::Binary {
                left: expr.left.span().byte_range(),
                op,
                right: expr.right.span().byte_range(),
            };
            self.site(expr.span().byte_range(), kind, mutants);
        }
        visit::visit_expr_binary(self, expr);
    }

    fn visit_expr_unary(&mut self, expr: &'ast syn::ExprUnary) {
        if let Some(mutants) = self.take("UnaryOperator", expr.op.span()) {
            let op = self.source[expr.op.span().byte_range()].to_owned();
            let kind = Kind::Unary { op, operand: expr.expr.span().byte_range() };
            self.site(expr.span().byte_range(), kind, mutants);
        }
        visit::visit_expr_unary(self, expr);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let Some(mutants) = self.take("MatchArm", arm.span()) {
            let end = match &arm.guard {
                Some((_, guard)) => guard.span().byte_range().end,
                None => arm.pat.span().byte_range().end,
            };
            self.site(arm.pat.span().byte_range().start..end, Kind::Arm, mutants);
        }
        if let Some((_, guard)) = &arm.guard
            && !has_let(guard)
            && let Some(mutants) = self.take("MatchArmGuard", guard.span())
        {
            self.site(guard.span().byte_range(), Kind::Guard, mutants);
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_struct(&mut self, expr: &'ast syn::ExprStruct) {
        if let Some(base) = &expr.rest {
            for field in &expr.fields {
                if let Some(mutants) = self.take("StructField", field.span()) {
                    let name = self.source[field.member.span().byte_range()].to_owned();
                    let kind = Kind::Field {
                        name,
                        value: field.expr.span().byte_range(),
                        base: base.span().byte_range(),
                    };
                    self.site(field.span().byte_range(), kind, mutants);
                }
            }
        }
        visit::visit_expr_struct(self, expr);
    }
}

/// The sites of one file's mutants, those around others first. Mutants without a site cannot be woven.
pub fn sites(source: &str, file: &str, mutants: &[Mutant]) -> Result<Vec<Site>> {
    let mut wanted: HashMap<_, Vec<_>> = HashMap::new();
    for (index, mutant) in mutants.iter().enumerate().filter(|(_, mutant)| mutant.file == file) {
        let place = (group(&mutant.genre), mutant.start.0, mutant.start.1);
        wanted.entry(place).or_default().push((index + 1, mutant.replacement.clone()));
    }
    let mut finder = Finder { wanted, source, sites: Vec::new() };
    finder.visit_file(&syn::parse_file(source)?);
    let mut sites = finder.sites;
    sites.sort_by_key(|site| (site.range.start, usize::MAX - site.range.end, site.kind.rank()));
    Ok(sites)
}
