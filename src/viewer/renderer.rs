//! What makes the pictures that the window shows: the kernels, and the renderers that the viewer
//! was given beside them.

use std::sync::Arc;

use crate::Kernel;

/// What makes a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Renderer {
    /// The tracer with this kernel.
    Kernel(Kernel),
    /// A renderer that the viewer was given.
    Given(GivenRenderer),
}

/// One of the renderers that the viewer was given.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GivenRenderer {
    /// Its place among them.
    pub(super) number: usize,
    pub(super) name: Arc<str>,
    /// How often its files have changed.
    pub(super) edition: u64,
}

impl Renderer {
    pub(super) fn name(&self) -> &str {
        match self {
            Renderer::Kernel(kernel) => kernel.name(),
            Renderer::Given(given) => &given.name,
        }
    }
}

/// All of them, and the one that is shown.
pub(super) struct Renderers {
    all: Vec<Renderer>,
    shown: usize,
}

impl Renderers {
    /// The kernels and renderers of these `names`; `kernel` is shown, else the first renderer, else
    /// the default kernel.
    pub(super) fn new(names: impl Iterator<Item = Arc<str>>, kernel: Option<Kernel>) -> Renderers {
        let given = names.enumerate().map(|(number, name)| {
            Renderer::Given(GivenRenderer {
                number,
                name,
                edition: 0,
            })
        });
        let all: Vec<_> = Kernel::ALL
            .into_iter()
            .map(Renderer::Kernel)
            .chain(given)
            .collect();
        let shown = match kernel {
            None if all.len() > Kernel::ALL.len() => Kernel::ALL.len(),
            kernel => {
                let kernel = Renderer::Kernel(kernel.unwrap_or_default());
                all.iter().position(|one| *one == kernel).unwrap_or(0)
            }
        };
        Renderers { all, shown }
    }

    pub(super) fn shown(&self) -> &Renderer {
        &self.all[self.shown]
    }

    /// Shows the next one, after the last the first.
    pub(super) fn show_next(&mut self) {
        self.shown = (self.shown + 1) % self.all.len();
    }

    /// A file of the given renderer of this number has changed.
    pub(super) fn has_changed(&mut self, number: usize) {
        if let Some(Renderer::Given(given)) = self.all.get_mut(Kernel::ALL.len() + number) {
            given.edition += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_and_given_renderers_take_turns() {
        let names = || ["one", "two"].into_iter().map(Arc::from);
        let mut renderers = Renderers::new(names(), None);
        let mut seen = Vec::new();
        for _ in 0..=Kernel::ALL.len() + 2 {
            seen.push(renderers.shown().name().to_owned());
            renderers.show_next();
        }
        let kernels = Kernel::ALL.map(Kernel::name);
        let turn = ["one", "two"].iter().chain(&kernels).chain(&["one"]);
        assert_eq!(seen, turn.copied().collect::<Vec<_>>());

        let chosen = Renderers::new(names(), Some(Kernel::Listing));
        assert_eq!(*chosen.shown(), Renderer::Kernel(Kernel::Listing));
        let none = Renderers::new([].into_iter(), None);
        assert_eq!(*none.shown(), Renderer::Kernel(Kernel::default()));
    }

    #[test]
    fn a_changed_renderer_is_another_one() {
        let mut renderers = Renderers::new([Arc::from("one")].into_iter(), None);
        let before = renderers.shown().clone();
        renderers.has_changed(1);
        assert_eq!(*renderers.shown(), before, "there is no second one");
        renderers.has_changed(0);
        assert_ne!(*renderers.shown(), before);
    }
}
