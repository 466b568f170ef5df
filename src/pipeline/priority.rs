//! The order in which vertices would go, as colours to look at.

use crate::mesh::Color;

/// A colour for each cost, by rank: from blue, which goes first, to red, which goes last or stays. Equal costs have one
/// colour.
pub(super) fn colors_of(costs: &[f64]) -> Vec<Option<Color>> {
    let mut order: Vec<u32> = (0..costs.len() as u32).collect();
    let cost = |v: u32| costs[v as usize];
    order.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)));
    let last = (costs.len().max(2) - 1) as f64;
    let mut colors = vec![None; costs.len()];
    let mut rank = 0;
    for equal in order.chunk_by(|&a, &b| cost(a) == cost(b)) {
        let share = if cost(equal[0]).is_finite() { rank as f64 / last } else { 1.0 };
        let red = (255.0 * share).round() as u8;
        equal.iter().for_each(|&v| colors[v as usize] = Some(Color::Bytes([red, 0, 255 - red], None)));
        rank += equal.len();
    }
    colors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cheapest_is_blue_and_the_dearest_red() {
        let color = |red: u8| Some(Color::Bytes([red, 0, 255 - red], None));
        assert_eq!(colors_of(&[9.0, 1.0, 4.0, 1.0, 7.0, 8.0]), [255, 0, 102, 0, 153, 204].map(color));
        assert_eq!(colors_of(&[f64::INFINITY, 0.0, f64::INFINITY]), [255, 0, 255].map(color));
        assert_eq!(colors_of(&[]), []);
    }
}
