//! What stays of a flight whose files are read again, photo by photo by their names: they may be others by now, or in
//! another order.

use std::collections::HashMap;

use crate::open_flight::OpenFlight;

/// Where the photos of before are now.
struct Moved(Vec<Option<usize>>);

impl Moved {
    fn new(before: &OpenFlight, now: &OpenFlight) -> Self {
        let photos = now.flight().parts().photos.iter();
        let now_at: HashMap<&str, usize> =
            photos.map(|photo| photo.name.as_str()).zip(0..).collect();
        let before = before.flight().parts().photos.iter();
        Self(
            before
                .map(|photo| now_at.get(photo.name.as_str()).copied())
                .collect(),
        )
    }

    fn now_at(&self, photo: usize) -> Option<usize> {
        self.0.get(photo).copied().flatten()
    }

    /// Whether each of `count` photos is where it was.
    fn is_same_order(&self, count: usize) -> bool {
        self.0.iter().copied().eq((0..count).map(Some))
    }
}

impl OpenFlight {
    /// Takes over what the engineer did from the flight before it was read again with other settings. Returns what is
    /// gone, a sentence each.
    pub(crate) fn keep_from(&mut self, mut before: Box<Self>) -> Vec<String> {
        let moved = Moved::new(&before, self);
        self.first_number = before.first_number;
        self.files.saved = before.files.saved.clone();
        // Saved elsewhere while the file was read.
        self.files.path.clone_from(&before.files.path);
        self.files.options.clone_from(&before.files.options);
        self.files.origin = before.files.origin.clone();
        self.files.opened_file.clone_from(&before.files.opened_file);
        self.files.bundled = before.files.bundled;
        self.files.kept.clone_from(&before.files.kept);
        // The settings are those of before, whoever changed the file meanwhile.
        self.files.stood = before.files.stood.clone();
        if self.computed.placed == before.computed.placed {
            self.planning.keep_from(&mut before.planning);
        }
        std::mem::swap(&mut self.control, &mut before.control);
        let fragments = std::mem::take(&mut before.fragments).of_another_surface();
        let (fragments, gone) = fragments.moved(|photo| moved.now_at(photo));
        self.fragments = fragments;
        let is_same_order = moved.is_same_order(self.review.count());
        self.objects.tracing = before.objects.tracing.take().filter(|_| is_same_order);
        std::mem::swap(&mut self.georeferencing, &mut before.georeferencing);
        let gone = gone.into_iter().map(|photo| {
            let photo = before.name(photo);
            format!("photo '{photo}' is not in the flight any more: its outlines, which no file has, are gone")
        });
        let mut gone: Vec<String> = gone.collect();
        gone.extend(self.keep_looks(&mut before, &moved));
        std::mem::swap(&mut self.history, &mut before.history);
        before.let_go();
        gone
    }

    /// Takes over how one looked at the flight before its files were read again, as they are now: what is decided and
    /// set is theirs. Returns what is gone, a sentence each.
    pub(crate) fn look_as(&mut self, mut before: Box<Self>) -> Vec<String> {
        let moved = Moved::new(&before, self);
        let gone = self.keep_looks(&mut before, &moved);
        before.let_go();
        gone
    }

    /// Whether coordinates mean the same place as before: else what was clicked and looked at is elsewhere. Control
    /// points bring a flight to another place, and so may its files.
    fn is_where(&self, before: &Self) -> bool {
        let (now, then) = (self.extent.all, before.extent.all);
        let meet = now.min.cmple(then.max).all() && then.min.cmple(now.max).all();
        meet && self.computed.placed == before.computed.placed
    }

    /// Takes over what is selected, shown and measured.
    fn keep_looks(&mut self, before: &mut Self, moved: &Moved) -> Vec<String> {
        let mut gone = Vec::new();
        // Clouds beside the surface are among them.
        self.files.read.extend(&before.files.read);
        self.colors.keep_limits(&before.colors);
        self.map.ground = before.map.ground;
        if self.is_where(before) {
            self.pointer.measure = before.pointer.measure;
            self.pointer.drawn = before.pointer.drawn.take();
            self.pointer.put_away = std::mem::take(&mut before.pointer.put_away);
            self.pointer.second = before.pointer.second.take();
            std::mem::swap(&mut self.beside, &mut before.beside);
            std::mem::swap(&mut self.pointer.picked, &mut before.pointer.picked);
            self.clip = before.clip;
            std::mem::swap(&mut self.clip_history, &mut before.clip_history);
            self.looking = before.looking;
            if !self.looking.turned {
                // It shows everything, which may be more by now.
                self.fit();
            }
            self.map.looking = before.map.looking;
        } else {
            self.looking.size = before.looking.size;
            let picked = !before.pointer.picked.history.now().is_empty();
            let all = [
                (!before.beside.is_empty(), "clouds beside the surface"),
                (
                    before.pointer.second.is_some(),
                    "the second surface of volumes",
                ),
                (picked, "picked points"),
            ];
            let were_there = all.into_iter().filter(|(is_there, _)| *is_there);
            gone.extend(were_there.map(|(_, what)| {
                format!("{what} were of where the flight was before, and are gone: add them anew")
            }));
        }
        self.photo_view.placing = before.photo_view.placing;
        self.photo_view.image = before.photo_view.image;
        for beside in &mut self.beside {
            // The local frame may be another one.
            beside.uploaded = None;
        }
        self.objects.sizes = before.objects.sizes;
        let notes = std::mem::take(&mut before.reviewing.notes).into_iter();
        let notes = notes.filter_map(|(photo, note)| Some((moved.now_at(photo)?, note)));
        self.reviewing.notes = notes.collect();
        self.looking.through = self.looking.through.and_then(|photo| moved.now_at(photo));
        self.selected = before
            .selected
            .and_then(|photo| moved.now_at(photo).or(self.selected));
        std::mem::swap(&mut self.table.order, &mut before.table.order);
        self.arrange();
        gone
    }
}
