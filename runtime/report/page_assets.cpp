#include "railtab/runtime/report/page_assets.hpp"

namespace railtab::report {

std::string_view page_style() {
  return R"css(
:root{--ink:#1d2430;--soft:#5b6675;--line:#dfe4ea;--c0:#0b6aa2;--c1:#c8442f;--c2:#d98e04;--c3:#2e7d52;--band:#b9c5d2;--hit:#c8442f}
*{box-sizing:border-box}
body{margin:0;background:#fff;color:var(--ink);font:15px/1.5 system-ui,"Segoe UI","Helvetica Neue",Arial,sans-serif;font-variant-numeric:tabular-nums}
main{max-width:1080px;margin:0 auto;padding:32px 24px 64px}
h1{font-size:26px;line-height:1.25;margin:0 0 4px;letter-spacing:-.01em;overflow-wrap:anywhere}
h2{font-size:19px;margin:44px 0 4px;padding-top:14px;border-top:1px solid var(--line)}
h3{font-size:15px;margin:0}h4{font-size:13px;margin:0 0 4px;color:var(--soft)}
.lead{color:var(--soft);margin:0 0 20px}.tiles+.lead{font-size:13px;margin-top:10px}
.warning{border-left:4px solid var(--c1);background:#fdf3f1;padding:10px 14px;margin:0 0 20px}
.tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(180px,1fr));gap:12px;margin:0;padding:0}
.tiles div{border:1px solid var(--line);border-radius:6px;padding:10px 14px}
.tiles dt{font-size:13px;color:var(--soft)}.tiles dd{margin:0}
.tiles .value{font-size:23px;line-height:1.3;font-weight:600;white-space:nowrap}.tiles .value small{font-size:14px;font-weight:400;color:var(--soft)}
.tiles .where{font-size:12px;color:var(--soft)}
figure{margin:22px 0 0}figcaption p{margin:0;font-size:13px;color:var(--soft)}
.legend{display:flex;flex-wrap:wrap;gap:2px 18px;list-style:none;margin:6px 0 0;padding:0;font-size:13px}
.legend i{display:inline-block;width:18px;height:0;border-top:3px solid;margin-right:6px;vertical-align:middle}
.legend i.band{border-top:10px solid var(--band)}
i.c0{border-color:var(--c0)}i.c1{border-color:var(--c1)}i.c2{border-color:var(--c2)}i.c3{border-color:var(--c3)}
.y-label{font-size:12px;color:var(--soft);margin-top:8px}.x-label{font-size:12px;color:var(--soft);text-align:center;padding-left:52px}
.plot{padding:8px 14px 22px 52px}
.area{position:relative;height:230px;border-left:1px solid #9aa5b1}
.area svg{position:absolute;inset:0;width:100%;height:100%;overflow:hidden}
.area svg *{vector-effect:non-scaling-stroke;fill:none}
.grid{stroke:#eceff3;stroke-width:1}.zero{stroke:#9aa5b1;stroke-width:1}
.area svg .band{fill:var(--band);stroke:var(--band);stroke-width:1}
.limit{stroke:#7a2318;stroke-width:1.2;stroke-dasharray:6 4}
.line{stroke-width:1.3;stroke-linejoin:round}.line.c0{stroke:var(--c0)}.line.c1{stroke:var(--c1)}.line.c2{stroke:var(--c2)}.line.c3{stroke:var(--c3)}
.ytick,.xtick,.limit-name{position:absolute;font-size:12px;line-height:1;color:var(--soft);white-space:nowrap;pointer-events:none}
.ytick{right:calc(100% + 7px);transform:translateY(-50%)}.xtick{top:calc(100% + 7px);transform:translateX(-50%)}
.limit-name{right:4px;transform:translateY(-115%);color:#7a2318;background:#ffffffd0;padding:1px 3px}
.cursor{position:absolute;top:0;bottom:0;width:1px;background:#59636f;pointer-events:none}
.readout{position:absolute;top:4px;z-index:1;background:#fffffff0;border:1px solid var(--line);border-radius:4px;padding:4px 8px;font-size:12px;line-height:1.45;white-space:nowrap;pointer-events:none;box-shadow:0 1px 4px #0002}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:24px;margin-top:10px}.pair p{font-size:13px;color:var(--soft);margin:2px 0 0}
.profiles{width:100%;height:auto;display:block}.profiles polyline{fill:none;stroke:var(--ink);stroke-width:.55;stroke-linejoin:round}
.profiles .hits{stroke:var(--hit);stroke-width:.5;fill:none}.profiles .scale{stroke:var(--soft);stroke-width:.35;fill:none}
.profiles text{font-size:4px;fill:var(--soft);text-anchor:middle}
.share{display:flex;height:30px;border-radius:4px;overflow:hidden;margin:12px 0 8px}.share svg{width:100%;height:100%}
table{border-collapse:collapse;font-size:14px}td,th{padding:3px 18px 3px 0;text-align:left;font-weight:400;vertical-align:top}td.n{text-align:right}
th i{display:inline-block;width:12px;height:12px;border-radius:2px;margin-right:8px;vertical-align:-1px}
pre{background:#f6f8fa;border:1px solid var(--line);border-radius:6px;padding:12px 14px;overflow:auto;font:13px/1.45 ui-monospace,Consolas,monospace}
summary{cursor:pointer;margin-top:18px}footer{margin-top:40px;font-size:13px;color:var(--soft)}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:8px 40px}
@media(max-width:640px){main{padding:20px 14px 40px}h1{font-size:22px}.xtick.spare{display:none}.area{height:190px}.plot{padding-right:10px}
.tiles{grid-template-columns:repeat(2,1fr);gap:8px}.tiles div{padding:8px 10px}.tiles .value{font-size:19px}}
@media print{main{max-width:none;padding:0}figure,.tiles div{break-inside:avoid}details:not([open])>*{display:block}}
)css";
}

std::string_view page_script() {
  // The values are read back from the drawn lines: the page holds every number once.
  return R"js(
document.querySelectorAll('.area').forEach(function(area){
  var x=area.dataset.x.split(',').map(Number),y=area.dataset.y.split(',').map(Number),lines=null,cursor,box;
  function load(){
    lines=[].map.call(area.querySelectorAll('path.line'),function(p){
      var n=p.getAttribute('d').match(/[-.0-9]+/g).map(Number),a=[],b=[];
      for(var i=0;i<n.length;i+=2){a.push(n[i]);b.push(n[i+1]);}
      return{label:p.dataset.label,a:a,b:b};});
    cursor=area.appendChild(document.createElement('div'));cursor.className='cursor';
    box=area.appendChild(document.createElement('div'));box.className='readout';}
  function shown(v){return Number(v.toPrecision(4)).toString().replace('-','\u2212');}
  area.addEventListener('pointermove',function(e){
    if(!lines)load();
    var r=area.getBoundingClientRect(),at=Math.min(1000,Math.max(0,1000*(e.clientX-r.left)/r.width));
    cursor.style.display=box.style.display='block';cursor.style.left=at/10+'%';
    box.textContent='';
    [area.dataset.xlabel+': '+shown(x[0]+at/1000*(x[1]-x[0]))].concat(lines.map(function(l){
      var lo=0,hi=l.a.length-1;
      while(hi-lo>1){var m=(lo+hi)>>1;if(l.a[m]<=at)lo=m;else hi=m;}
      var k=Math.abs(l.a[lo]-at)<Math.abs(l.a[hi]-at)?lo:hi;
      if(Math.abs(l.a[k]-at)>8)return l.label+': \u2013';
      return l.label+': '+shown(y[0]+(1-l.b[k]/1000)*(y[1]-y[0]));
    })).forEach(function(t){box.appendChild(document.createElement('div')).textContent=t;});
    box.style.left=at<500?'calc('+at/10+'% + 10px)':'auto';box.style.right=at<500?'auto':'calc('+(100-at/10)+'% + 10px)';
  });
  area.addEventListener('pointerleave',function(){if(lines)cursor.style.display=box.style.display='none';});
});
)js";
}

}  // namespace railtab::report
