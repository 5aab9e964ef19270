//! How a flight's surface is: its colours, its distance, its holes, its points.

use super::doubted::{doubted, only_where_doubted, share};
use super::of_photos::files_found;
use super::{Health, HealthFinding, HealthItem, Remedy, of};
use crate::flight::{ColoursFound, Review, TogetherFound};

pub(super) fn colours(review: &Review) -> HealthFinding {
    let item = HealthItem::Colours;
    if let Some(doubted) = doubted(review, item) {
        return of(
            item,
            Health::Bad,
            doubted.share(review),
            doubted.says(review),
        );
    }
    if review.flight().parts().surface.colors().is_empty() {
        let says = "The surface has no colours: none say whether the photos show this pile.";
        return of(item, Health::Unknown, "none", says.to_owned()).with(Remedy::AddSurface);
    }
    let evidence = &review.looked_up().evidence;
    let count = |of: ColoursFound| evidence.iter().filter(|e| e.colours == of).count();
    let compared = count(ColoursFound::NothingAgainst);
    let found = files_found(review);
    if found == 0 || compared + count(ColoursFound::CannotTell) < found {
        let says = format!(
            "The surface has colours; those of {} were compared with it so far.",
            share(compared, review)
        );
        return of(item, Health::Unknown, "not compared", says);
    }
    if compared == 0 {
        let says = "The surface has colours, and too few of them are in the photos' sight to compare them.";
        return of(item, Health::Unknown, "unclear", says.to_owned());
    }
    let says = format!(
        "Nothing in the colours of {} speaks against the surface.",
        share(compared, review)
    );
    of(item, Health::Good, "same", says)
}

pub(super) fn distance(review: &Review) -> Option<HealthFinding> {
    let item = HealthItem::Distance;
    if let Some(doubted) = doubted(review, item) {
        let share = doubted.share(review);
        return Some(of(item, Health::Bad, share, doubted.says(review)));
    }
    let evidence = review.looked_up().evidence.iter();
    let of_compared = evidence.filter_map(|evidence| match &evidence.together {
        TogetherFound::NotCompared => None,
        TogetherFound::There { off, .. } => Some(Some(*off)),
        TogetherFound::Unclear | TogetherFound::Against(_) => Some(None),
    });
    let of_compared: Vec<Option<f64>> = of_compared.collect();
    let there: Vec<f64> = of_compared.iter().copied().flatten().collect();
    let worst = there.iter().copied().reduce(f64::max);
    let Some(worst) = worst else {
        let says = "The photos and those beside them do not tell where the surface is.".to_owned();
        return (!of_compared.is_empty()).then(|| of(item, Health::Unknown, "unclear", says));
    };
    let seen = share(there.len(), review);
    let rest = match there.len() == review.count() {
        true => "",
        false => " The others do not say so: they do not tell, or are beside none.",
    };
    let says = format!(
        "{seen} see the surface where it is, together with those beside them: within {:.1} % of its distance.{rest}",
        worst * 100.0
    );
    let short = match rest {
        "" => "as seen".to_owned(),
        _ => seen,
    };
    let health = match 2 * there.len() > of_compared.len() {
        true => Health::Good,
        false => Health::Unknown,
    };
    Some(of(item, health, short, says))
}

pub(super) fn holes(review: &Review) -> HealthFinding {
    let item = HealthItem::Holes;
    if let Some(doubted) = doubted(review, item) {
        let says = format!(
            "{} look over a hole or an edge of the surface; the first: {}.",
            doubted.share(review),
            doubted.first
        );
        return of(item, Health::Bad, doubted.share(review), says).with(Remedy::AddSurface);
    }
    match review.is_looked_at() && review.count() > 0 {
        true => {
            let says = "Every photo's corners are on the surface, none over a hole.".to_owned();
            of(item, Health::Good, "none", says)
        }
        false => {
            let says = "Nobody has looked at the photos' footprints yet.".to_owned();
            of(item, Health::Unknown, "…", says)
        }
    }
}

pub(super) fn points(review: &Review) -> Option<HealthFinding> {
    let finding = only_where_doubted(review, HealthItem::Points);
    finding.map(|finding| finding.with(Remedy::AddSurface))
}
